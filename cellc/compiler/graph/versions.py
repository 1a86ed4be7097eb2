"""The version tuple as pins, each at its place, and whether they go together as far as a matrix says."""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum

from cellc.compiler.catalog.load import load_distros, load_packages
from cellc.compiler.catalog.tables import DistroFacts, ReleaseSet
from cellc.compiler.catalog.version_rows import RepositoryPin, VersionRow
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.graph.releases import PACKAGED, foreign_lines, named_row, own_release, were_together
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.pins import version_number, version_numbers
from cellc.contract.vocabulary import UNKNOWN

_DEVICE_PARTS = ("revision", "firmware", *PACKAGED)


@dataclass(frozen=True, slots=True)
class Pin:
    """One part of the tuple: ``holder`` is the cell or a device, ``text`` as written."""

    holder: str
    part: str
    text: str
    path: YamlPath

    @property
    def known(self) -> bool:
        """Whether something else than UNKNOWN is written."""
        return self.text != UNKNOWN


def is_known_package(name: str) -> bool:
    """Whether a package of this name is in a distribution, or of a vendor that the catalog names."""
    table = load_packages().value
    return table is not None and table.has(name)


def cell_pins(cell: Cell) -> Iterator[Pin]:
    """Yield the parts of the tuple that belong to the whole cell; MoveIt is no part of a cell that has no goals."""
    versions = cell.versions
    texts = {
        "os": versions.os,
        "kernel": versions.kernel,
        "ros": versions.ros,
        "rmw": versions.rmw,
        "ros2_control": versions.ros2_control,
        "moveit": versions.moveit,
    }
    for part, text in texts.items():
        if part != "moveit" or cell.goals or text != UNKNOWN:
            yield Pin(cell.name, part, text, ("versions", part))


def device_pins(cell: Cell) -> Iterator[Pin]:
    """Yield the parts of the tuple of each device; what its catalog entry says it has none of is left out."""
    for device in cell.devices:
        packages = device.software.packages
        absent = {"driver": packages.driver, "sdk": packages.sdk, "description": packages.description}
        absent |= {"firmware": None} if device.is_only_switched else {}
        for part in _DEVICE_PARTS:
            text = device.software.versions.part(part)
            if text != UNKNOWN or absent.get(part, part) is not None:
                yield Pin(device.name, part, text, (*device.path, part))


def distribution(cell: Cell) -> DistroFacts | None:
    """Return the facts of the pinned distribution, or None where the catalog has none."""
    table = load_distros().value
    known = {} if table is None else dict(table.distros.items())
    return next((facts for name, facts in known.items() if name == cell.distro), None)


class Answer(str, Enum):
    """What a matrix says of one part; what no matrix names stays UNKNOWN."""

    OK = "OK"
    INCOMPATIBLE = "INCOMPATIBLE"
    UNKNOWN = "UNKNOWN"


@dataclass(frozen=True, slots=True)
class Judgment:
    """One part of the tuple with the answer, and what the answer rests on.

    ``built_from`` are the repositories that it is built from where the distribution does not release it.
    """

    pin: Pin
    answer: Answer
    evidence: str
    built_from: tuple[RepositoryPin, ...] = ()


def compatibility(cell: Cell) -> tuple[Judgment, ...]:
    """Judge every part of the tuple, the cell's first."""
    return (*_of_cell(cell), *_of_devices(cell))


def unreleased(cell: Cell) -> dict[str, RepositoryPin]:
    """Return the repositories that a workspace needs because the distribution does not release what is pinned."""
    pins = (pin for judged in compatibility(cell) for pin in judged.built_from)
    return {pin.name: pin for pin in sorted(pins, key=lambda pin: pin.name)}


def _of_cell(cell: Cell) -> Iterator[Judgment]:
    facts, table = distribution(cell), load_distros().value
    together = were_together(cell.distro, {_package(pin): pin.text for pin in cell_pins(cell) if pin.known})
    for pin in cell_pins(cell):
        if not pin.known:
            yield Judgment(pin, Answer.UNKNOWN, "not pinned")
        elif facts is None or table is None:
            yield Judgment(pin, Answer.UNKNOWN, "the catalog has no such distribution")
        else:
            answer, evidence = _cell_answer(pin, facts, together)
            yield Judgment(pin, answer, f"{evidence} (as of {table.as_of})")


def _package(pin: Pin) -> str:
    return pin.text.split()[0] if pin.part == "rmw" else pin.part


def _cell_answer(pin: Pin, facts: DistroFacts, together: ReleaseSet | None) -> tuple[Answer, str]:
    if pin.part == "ros":
        return Answer.OK, f"end of life {facts.end_of_life}"
    if pin.part == "os":
        return _os_answer(pin.text.lower(), facts)
    name = _package(pin)
    if pin.part == "rmw" and name not in (*facts.rmw, *facts.rmw_unverified):
        return Answer.INCOMPATIBLE, f"{facts.title} has {', '.join(facts.rmw)}"
    released = facts.packages.get(name, "")
    if not released:
        return Answer.UNKNOWN, "no matrix lists it"
    if version_number(pin.text) == version_number(released):
        return Answer.OK, f"{facts.title} releases {released}"
    if together is not None and name in together.packages:
        return Answer.OK, f"{together.name} had it, together with the other pinned parts"
    # MoveIt and Zenoh's middleware stay below 3 for years: their second number is what changes with the distribution.
    digits = 2 if name in ("moveit", "rmw_zenoh_cpp") and version_numbers(released)[:1] <= (2,) else 1
    if version_numbers(pin.text)[:digits] != version_numbers(released)[:digits]:
        return Answer.INCOMPATIBLE, f"{facts.title} releases {released}"
    return Answer.UNKNOWN, f"{facts.title} releases {released}; this one is not tested with it"


def _os_answer(written: str, facts: DistroFacts) -> tuple[Answer, str]:
    if any(written == due or written.startswith(f"{due}.") for due in facts.os):
        return Answer.OK, f"{facts.title} supports it"
    if any(written == due or written.startswith(f"{due}.") for due in facts.os_tier3):
        return Answer.UNKNOWN, "third tier: built from source, untested by the distribution"
    return Answer.INCOMPATIBLE, f"{facts.title} supports {', '.join(facts.os)}"


def _of_devices(cell: Cell) -> Iterator[Judgment]:
    devices = {device.name: device for device in cell.devices}
    for pin in device_pins(cell):
        if not pin.known:
            yield Judgment(pin, Answer.UNKNOWN, "not pinned")
            continue
        device = devices[pin.holder]
        rows = tuple(row for row in device.software.version_rows if row.part == pin.part)
        row = named_row(pin.text, pin.part, rows, cell.distro)
        if pin.part not in PACKAGED:
            answer, evidence = _firmware_answer(pin, rows)
        elif row is not None:
            answer, evidence = _known_answer(row, cell.distro)
        else:
            answer, evidence = _unnamed_answer(pin, device, rows, cell.distro)
        yield Judgment(pin, answer, evidence, () if row is None else row.built_from)


def _firmware_answer(pin: Pin, rows: tuple[VersionRow, ...]) -> tuple[Answer, str]:
    numbers = version_numbers(pin.text)
    for row in rows:
        if row.product != pin.text.split()[0] or not numbers:
            continue
        least, below = version_numbers(row.minimum or ""), version_numbers(row.below or "")
        inside = (not least or numbers >= least) and (not below or numbers < below)
        bounds = f"from {row.minimum or 'any'}" + (f", below {row.below}" if row.below else "")
        return (Answer.OK if inside else Answer.INCOMPATIBLE), f"{bounds}: {_origin(row)}"
    return Answer.UNKNOWN, "no matrix lists it"


def _unnamed_answer(pin: Pin, device: Device, rows: tuple[VersionRow, ...], distro: str) -> tuple[Answer, str]:
    foreign = foreign_lines(device, pin.part, distro)
    if foreign:
        return Answer.INCOMPATIBLE, f"it belongs to {foreign[0].distro}: {_origin(foreign[0])}"
    release = own_release(device, distro)
    if release is not None:
        together = f"the packages of `{pin.holder}` belong together: {release.name}"
        return (Answer.UNKNOWN, f"{together}, built from source") if release.built else (Answer.OK, together)
    here = [row for row in rows if row.distro in (None, distro) and row.known]
    known = ", ".join(known for row in here for known in row.known)
    return Answer.UNKNOWN, f"{known} on {distro}: {_origin(here[0])}" if here else "no matrix lists it"


def _known_answer(row: VersionRow, distro: str) -> tuple[Answer, str]:
    if row.ambiguous is not None:
        return Answer.UNKNOWN, f"{row.ambiguous}: {_origin(row)}"
    if row.built_from:
        pin = row.built_from[0]
        built = f"{distro} does not release it; `sources.repos` builds it from {pin.name} at {pin.ref[:12]}"
        return Answer.UNKNOWN, f"{built}: {_origin(row)}"
    return Answer.OK, f"{', '.join(row.known)} on {distro}: {_origin(row)}"


def _origin(row: VersionRow) -> str:
    return f"{row.source}, as of {row.as_of}"
