"""Rules on packages."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.graph.releases import was_released
from cellc.compiler.graph.versions import Pin, cell_pins, device_pins, distribution, is_known_package
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule
from cellc.contract.pins import pinned_package, version_numbers
from cellc.contract.vocabulary import UNKNOWN

_FLOATING = re.compile(r"(?i)\b(latest|main|master|devel|develop|head|nightly|stable|any|tip)\b|[<>~^*]|\.x\b")


@rule(Severity.ERROR)
def floating_version(graph: CellGraph) -> Findings:
    """Yield parts of the tuple that name a branch, a range or the latest."""
    rollback = graph.cell.versions.rollback
    pins = [*cell_pins(graph.cell), *device_pins(graph.cell)]
    pins.append(Pin(graph.cell.name, "rollback image", rollback.image, ("versions", "rollback", "image")))
    for pin in pins:
        match = _FLOATING.search(pin.text)
        if match is not None:
            message = f"`{pin.part}` of `{pin.holder}` is `{pin.text}`, which is not one exact version"
            yield found(graph, pin.path, message)


@rule(Severity.ERROR)
def package_of_another_distribution(graph: CellGraph) -> Findings:
    """Yield ros2_control, MoveIt and middleware pins of another major version than the distribution ever released."""
    facts = distribution(graph.cell)
    for pin in cell_pins(graph.cell) if facts is not None else ():
        package = pin.text.split()[0] if pin.part == "rmw" else pin.part
        released = facts.packages.get(package, "") if facts is not None else ""
        ours, theirs = version_numbers(pin.text), version_numbers(released)
        # MoveIt and rmw_zenoh stay below 3 for years: their second number is what changes with the distribution.
        digits = 2 if theirs[:1] <= (2,) and package in ("moveit", "rmw_zenoh_cpp") else 1
        of_another = pin.known and ours and theirs and ours[:digits] != theirs[:digits]
        if of_another and not was_released(graph.cell.distro, package, pin.text):
            message = f"`{package}` `{pin.text}` is not released for {graph.cell.distro}, which has {released}"
            yield found(graph, pin.path, message, f"pin the line of {released}")


@rule(Severity.ERROR)
def shadowed_package(graph: CellGraph) -> Findings:
    """Yield a cell that is named after a package that it uses, or that the catalog knows."""
    name = graph.cell.name
    users = [path for package, path in _packages(graph) if package == name]
    if users or is_known_package(name):
        related = tuple(Related("the cell uses that package here", graph.cell.locate(*path)) for path in users[:1])
        yield found(graph, ("cell",), f"`{name}` must not be the name of another package", related=related)


def _packages(graph: CellGraph) -> Iterator[tuple[str | None, YamlPath]]:
    """Yield the packages that a cell names, and its devices."""
    cell = graph.cell
    yield from ((node.package, node.path) for node in cell.nodes)
    yield from ((controller.package, controller.path) for controller in cell.controllers)
    yield from ((group.solver.package, group.path) for group in cell.groups)
    yield from ((pipeline.package, ("motion", "pipelines")) for pipeline in cell.pipelines)
    for device in cell.devices:
        of_vendor = device.software.packages
        yield from ((name, device.path) for name in (of_vendor.driver, of_vendor.sdk, of_vendor.description))
        yield from ((program.package, device.path) for program in device.site.programs)
        if device.body.kinematics is not None:
            yield device.body.kinematics.package, device.path


_PACKAGES = ("driver", "sdk", "description")


@rule(Severity.ERROR)
def two_versions_of_one_package(graph: CellGraph) -> Findings:
    """Yield the second version of a package on one host; a description is read wherever the cell is."""
    hosts = {device.name: device.site.host for device in graph.cell.devices}
    first: dict[tuple[str, str], Pin] = {}
    for pin in device_pins(graph.cell):
        words = pin.text.split()
        if pin.part not in _PACKAGES or pin.text == UNKNOWN or len(words) != 2 or not version_numbers(pin.text):
            continue
        host = "" if pin.part == "description" else hosts[pin.holder]
        other = first.setdefault((words[0], host), pin)
        if version_numbers(other.text) != version_numbers(pin.text):
            number = other.text.split()[1]
            message = f"`{words[0]}` must have one version in a workspace, got {words[1]} for `{pin.holder}`"
            message += f" and {number} for `{other.holder}`"
            related = (Related(f"{number} is written here", graph.cell.locate(*other.path)),)
            yield found(graph, pin.path, message, related=related)


_PACKAGED = ("rmw", "driver", "sdk", "description")


@rule(Severity.ERROR, assumes=("unknown-rmw",))
def version_without_package(graph: CellGraph) -> Findings:
    """Yield parts of the tuple whose first of two words is not the name of a package."""
    for pin in (*cell_pins(graph.cell), *device_pins(graph.cell)):
        words = pin.text.split()
        if pin.part in _PACKAGED and len(words) == 2 and not pinned_package(pin.text):
            message = f"`{pin.part}` of `{pin.holder}` must begin with the name of a package, got `{words[0]}`"
            yield found(graph, pin.path, message)
