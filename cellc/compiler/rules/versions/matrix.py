"""Rules on versions against those that the catalog knows to work together."""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.graph.releases import (
    PACKAGED,
    differing,
    foreign_lines,
    nearest_release,
    own_release,
    shared_parts,
    unlisted,
)
from cellc.compiler.graph.versions import Pin, cell_pins, device_pins
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, did_you_mean, found, rule
from cellc.contract.pins import is_commit, last_word, version_number, version_numbers
from cellc.contract.vocabulary import UNKNOWN


@rule(Severity.ERROR)
def firmware_outside_matrix(graph: CellGraph) -> Findings:
    """Yield firmware below the minimum or beyond the range of the rows for its product."""
    for device in graph.cell.devices:
        text = device.software.versions.firmware
        product = text.split()[0]
        firmware = (row for row in device.software.version_rows if row.part == "firmware")
        rows = [row for row in firmware if row.product in (None, product)]
        numbers = version_numbers(text)
        products = {row.product for row in device.software.version_rows if row.part == "firmware"}
        if numbers and products and None not in products and product not in products:
            known = " or ".join(sorted(f"`{name}`" for name in products if name is not None))
            message = f"the firmware of `{device.name}` must be that of {known}, got `{text}`"
            yield found(graph, (*device.path, "firmware"), message, f"write {known} and its version")
        for row in rows if numbers else ():
            minimum, below = version_numbers(row.minimum or ""), version_numbers(row.below or "")
            if (minimum and numbers < minimum) or (below and numbers >= below):
                bounds = (row.minimum and f"at least {row.minimum}", row.below and f"below {row.below}")
                allowed = f"{' and '.join(bound for bound in bounds if bound)} ({row.as_of})"
                message = f"the firmware of `{device.name}` must be {allowed}, got `{text}`"
                yield found(graph, (*device.path, "firmware"), message, row.note or "update the firmware")


@rule(Severity.BLOCKER)
def unknown_version(graph: CellGraph) -> Findings:
    """Yield each part written as UNKNOWN, and the unwritten parts of each holder in one finding."""
    unwritten: dict[str, list[Pin]] = {}
    for pin in (*cell_pins(graph.cell), *device_pins(graph.cell)):
        if pin.known:
            continue
        if graph.cell.states(*pin.path):
            yield found(graph, pin.path, f"`{pin.part}` of `{pin.holder}` is UNKNOWN")
        else:
            unwritten.setdefault(pin.holder, []).append(pin)
    for holder, pins in unwritten.items():
        names = ", ".join(f"`{pin.part}`" for pin in pins)
        yield found(graph, pins[0].path[:-1], f"`{holder}` does not state its {names}")


@rule(Severity.BLOCKER)
def version_not_in_matrix(graph: CellGraph) -> Findings:
    """Yield devices with packages that no row has and no release has together; those of another line are an error."""
    distro = graph.cell.distro
    for device in graph.cell.devices:
        odd = [part for part in unlisted(device, distro) if not foreign_lines(device, part, distro)]
        if not odd or own_release(device, distro) is not None:
            continue
        near = nearest_release(device, distro)
        parts = odd if near is None else [*differing(device, near)] or odd
        known = _known(device, odd[0], distro)
        if near is not None:
            *first, last = [f"{part} {version}" for part, version in shared_parts(device, near).items()]
            known = f"{' and '.join((', '.join(first), last)) if first else last} in {near.name}, the nearest"
        texts = " and ".join(f"`{device.software.versions.part(part)}`" for part in parts)
        message = f"{texts} of `{device.name}` must be in the matrix of {distro}, which knows {known}"
        places = [(*device.path, part) for part in parts]
        related = tuple(Related("this version differs too", graph.cell.locate(*place)) for place in places[1:])
        yield found(graph, places[0], message, related=related)


def _known(device: Device, part: str, distro: str) -> str:
    rows = [row for row in device.software.version_rows if row.part == part and row.distro in (None, distro)]
    return ", ".join(sorted({name for row in rows for name in row.known})) or "none"


@rule(Severity.ERROR)
def version_outside_matrix(graph: CellGraph) -> Findings:
    """Yield parts whose major version is that of a row of another distribution and of no row or release of this one."""
    distro = graph.cell.distro
    for device in graph.cell.devices:
        for part in PACKAGED:
            others = {row.distro for row in foreign_lines(device, part, distro)}
            if others:
                names = " and ".join(sorted(name for name in others if name is not None))
                pinned = f"`{device.software.versions.part(part)}` of `{device.name}`"
                message = f"{pinned} is for {names}, but the cell runs {distro}"
                yield found(graph, (*device.path, part), message, f"pin the line of {distro}")


_NUMBERED = ("os", "kernel", "rmw", "ros2_control", "moveit", "firmware", "driver", "sdk", "description")


@rule(Severity.ERROR, assumes=("floating-version",))
def version_without_number(graph: CellGraph) -> Findings:
    """Yield parts of the tuple without a version number."""
    for pin in (*cell_pins(graph.cell), *device_pins(graph.cell)):
        versioned = version_number(pin.text) or is_commit(last_word(pin.text))
        if pin.known and pin.part in _NUMBERED and not versioned:
            message = f"`{pin.part}` of `{pin.holder}` is `{pin.text}`, without a version"
            advice = did_you_mean(pin.text, (UNKNOWN,), "")
            other = f"write `{pin.text.split()[0]}` and its version"
            yield found(graph, pin.path, message, advice if advice.is_near else other)
