"""The version tuple on another distribution: what each pin becomes, and what no matrix knows.

A pin that the target's rows know stays as it is. One of which the matrix says nothing at all stays too, for only people
know it; one that the matrix knows for other distributions alone becomes UNKNOWN.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from cellc.compiler.catalog.tables import DistroFacts
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device, Software
from cellc.compiler.graph.releases import PACKAGED, named_row, package_of
from cellc.compiler.graph.versions import Answer, Judgment, Pin, cell_pins, compatibility, device_pins
from cellc.contract.pins import same_version
from cellc.contract.stated import Versions
from cellc.contract.vocabulary import UNKNOWN, Distro


@dataclass(frozen=True, slots=True)
class PinMove:
    """A pin with the text that it has on the target, what the matrix says of that, and what is left to ask."""

    pin: Pin
    text: str
    judged: Judgment
    question: str


def moved_pins(cell: Cell, target: Distro, facts: DistroFacts) -> tuple[PinMove, ...]:
    """Return every pin of a cell with what it becomes on a distribution.

    Args:
        facts: of the target.
    """
    texts = {pin.path: _of_cell(pin, facts, target) for pin in cell_pins(cell)}
    devices = {device.name: device for device in cell.devices}
    texts |= {pin.path: _of_device(pin, devices[pin.holder], facts, target) for pin in device_pins(cell)}
    same_os = texts.get(("versions", "os")) == cell.versions.os
    if not same_os and cell.versions.kernel != UNKNOWN:
        texts["versions", "kernel"] = UNKNOWN
    before = {judged.pin.path: judged for judged in compatibility(cell)}
    after = {judged.pin.path: judged for judged in compatibility(_with_pins(cell, target, texts))}
    return tuple(
        PinMove(judged.pin, texts[path], after[path], _question(judged, after[path], target))
        for path, judged in before.items()
    )


def _with_pins(cell: Cell, target: Distro, texts: Mapping[tuple[str | int, ...], str]) -> Cell:
    """Return a cell with other pins, for the matrix alone: nothing else of it is linked again."""
    pins = {pin.part: texts[pin.path] for pin in cell_pins(cell)}
    versions = Versions(**{"ros": target.value, **pins}, rollback=cell.versions.rollback)
    of_device: dict[str, dict[str, str]] = {}
    for pin in device_pins(cell):
        of_device.setdefault(pin.holder, {})[pin.part] = texts[pin.path]
    devices = tuple(
        replace(device, software=_with_versions(device.software, of_device.get(device.name, {})))
        for device in cell.devices
    )
    return replace(cell, distro=target, versions=versions, devices=devices)


def _with_versions(software: Software, texts: Mapping[str, str]) -> Software:
    return replace(software, versions=replace(software.versions, **texts))


def _of_cell(pin: Pin, facts: DistroFacts, target: Distro) -> str:
    if pin.part == "ros":
        return target.value
    if not pin.known or pin.part == "kernel":
        return pin.text
    if pin.part == "os":
        text = pin.text.lower()
        return pin.text if any(text == due or text.startswith(f"{due}.") for due in facts.os) else facts.os[0]
    if pin.part == "rmw":
        name = pin.text.split()[0]
        offered = name in (*facts.rmw, *facts.rmw_unverified)
        return f"{name} {facts.packages[name]}" if offered and name in facts.packages else pin.text
    return _numbered(pin.text, facts.packages.get(pin.part))


def _numbered(text: str, version: str | None) -> str:
    """Return a pin with another version, and UNKNOWN without one; words before the version stay."""
    return UNKNOWN if version is None else " ".join((*text.split()[:-1], version))


def _of_device(pin: Pin, device: Device, facts: DistroFacts, target: Distro) -> str:
    rows = tuple(row for row in device.software.version_rows if row.part == pin.part and row.known)
    if not pin.known or pin.part not in PACKAGED or named_row(pin.text, pin.part, rows, target) is not None:
        return pin.text
    here = [row for row in rows if row.distro in (None, target) and row.ambiguous is None]
    if here:
        return _numbered(pin.text, here[0].known[-1])
    package = package_of(device, pin.part) or ""
    released = facts.packages.get(package)
    # A row that names a version twice says why the number that is released pins nothing.
    unclear = any(row.distro == target and same_version(released or "", known) for row in rows for known in row.known)
    if released is not None and not unclear:
        return _numbered(pin.text, released)
    return UNKNOWN if rows else pin.text


def _question(before: Judgment, after: Judgment, target: Distro) -> str:
    """Return what is asked of a pin: only what the new distribution brings up, not what was open before."""
    pin, text = before.pin, after.pin.text
    what = f"`{pin.part}` of `{pin.holder}`"
    if after.answer is Answer.OK or not pin.known or after.built_from:
        return ""
    if text == UNKNOWN:
        return f"{what}: no matrix lists a version for {target}; `{pin.text}` was pinned before"
    if after.answer is Answer.INCOMPATIBLE:
        return f"{what}: `{text}` is not compatible with {target}: {after.evidence}"
    if text != pin.text or pin.part in PACKAGED:
        return f"{what}: no matrix says whether `{text}` is compatible with {target}: {after.evidence}"
    return ""
