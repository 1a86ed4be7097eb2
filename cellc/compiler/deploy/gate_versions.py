"""Lines of the gates about versions: where each part of the version tuple is read, and which are UNKNOWN."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from cellc.compiler.deploy.configuration import version_tuple
from cellc.compiler.deploy.enabling import answers_when_powered, enabled_in
from cellc.compiler.deploy.gate_motion import Values
from cellc.compiler.deploy.versions import compared_on, fetched_parts, installed_parts
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import UNKNOWN, GateCode

_ROLLBACK = "rollback."


def built(graph: CellGraph) -> Iterator[Values]:
    """Yield what shows the commits to which parts are pinned: the source that was built, and no installed package."""
    commands = dict.fromkeys(part.source_command for part in installed_parts(graph.cell))
    return ((command,) for command in commands if command)


def elsewhere(graph: CellGraph) -> Iterator[Values]:
    """Yield what no computer of the cell compares, because none runs what it belongs to."""
    compared = {part for _, parts in compared_on(graph.cell) for part in parts}
    return ((part.name, part.text) for part in installed_parts(graph.cell) if part not in compared)


def visible(graph: CellGraph) -> Iterator[Values]:
    shown = {part.name for part in installed_parts(graph.cell)} | {name for name, *_ in fetched_parts(graph.cell)}
    late = {name for name, *_ in shown_with_power(graph)}
    for name, value in version_tuple(graph.cell).items():
        if value != UNKNOWN and name not in shown | late and not name.startswith(_ROLLBACK):
            yield name, value


def rollback(graph: CellGraph) -> Iterator[Values]:
    """Yield what the cell returns to after a bad change, where it is stated."""
    parts = version_tuple(graph.cell).items()
    return ((name, value) for name, value in parts if value != UNKNOWN and name.startswith(_ROLLBACK))


def shown_with_power(graph: CellGraph) -> Iterator[Values]:
    firmware = _firmware_with_power(graph)
    for name, value in version_tuple(graph.cell).items():
        if value != UNKNOWN and name in firmware:
            yield name, value, firmware[name]


def unknown(graph: CellGraph) -> Iterator[Values]:
    """Yield what is UNKNOWN of the cell, and of each device."""
    devices = {device.name for device in graph.cell.devices}
    late, parts = {name for name, _ in unknown_with_power(graph)}, defaultdict[str, list[str]](list)
    for name, value in version_tuple(graph.cell).items():
        if value == UNKNOWN and name not in late:
            holder, _, part = name.rpartition(".")
            of_device = holder in devices
            parts[holder if of_device else graph.cell.name].append(part if of_device else name)
    return ((holder, ", ".join(names)) for holder, names in parts.items())


def unknown_with_power(graph: CellGraph) -> Iterator[Values]:
    firmware = _firmware_with_power(graph)
    for name, value in version_tuple(graph.cell).items():
        if value == UNKNOWN and name in firmware:
            yield name, firmware[name]


def _firmware_with_power(graph: CellGraph) -> Mapping[str, GateCode]:
    """Return the firmware that no device shows before its drives have power, with the gate of that."""
    return {f"{each.name}.firmware": enabled_in(each) for each in graph.cell.devices if answers_when_powered(each)}
