"""Lines of the gates about versions: where each part of the version tuple is read, and which are UNKNOWN."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.deploy.configuration import version_tuple
from cellc.compiler.deploy.enabling import answers_when_powered, enabled_in
from cellc.compiler.deploy.gate_motion import Values
from cellc.compiler.deploy.versions import Installed, compared_on, fetched_parts, installed_parts
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.pins import is_commit, last_word
from cellc.contract.vocabulary import UNKNOWN, GateCode


def installed(graph: CellGraph) -> Iterator[Values]:
    yield from ((part.name, part.text, part.command, on) for on, part in _read(graph, commits=False))


def built(graph: CellGraph) -> Iterator[Values]:
    """Yield what is pinned to a commit, which the source that was built shows and no version of a package."""
    yield from ((part.name, part.text, part.command, on) for on, part in _read(graph, commits=True))


def _read(graph: CellGraph, *, commits: bool) -> Iterator[tuple[str, Installed]]:
    """Yield what a computer shows, after the computer; a cell that runs in one place names none."""
    places = tuple(compared_on(graph.cell))
    placed = {part for _, parts in places for part in parts}
    elsewhere = tuple(part for part in installed_parts(graph.cell) if part not in placed)
    for host, parts in (*places, ("", elsewhere)):
        where = f"On {host}: " if host else ""
        yield from ((where, part) for part in parts if is_commit(last_word(part.text)) is commits)


def visible(graph: CellGraph) -> Iterator[Values]:
    shown = {part.name for part in installed_parts(graph.cell)} | {name for name, *_ in fetched_parts(graph.cell)}
    late = {name for name, *_ in shown_with_power(graph)}
    for name, value in version_tuple(graph.cell).items():
        if value != UNKNOWN and name not in shown | late:
            yield name, value


def shown_with_power(graph: CellGraph) -> Iterator[Values]:
    firmware = _firmware_with_power(graph)
    for name, value in version_tuple(graph.cell).items():
        if value != UNKNOWN and name in firmware:
            yield name, value, firmware[name]


def unknown(graph: CellGraph) -> Iterator[Values]:
    late = {name for name, _ in unknown_with_power(graph)}
    return ((name,) for name, value in version_tuple(graph.cell).items() if value == UNKNOWN and name not in late)


def unknown_with_power(graph: CellGraph) -> Iterator[Values]:
    firmware = _firmware_with_power(graph)
    for name, value in version_tuple(graph.cell).items():
        if value == UNKNOWN and name in firmware:
            yield name, firmware[name]


def _firmware_with_power(graph: CellGraph) -> Mapping[str, GateCode]:
    """Return the firmware that no device shows before its drives have power, with the gate of that."""
    return {f"{each.name}.firmware": enabled_in(each) for each in graph.cell.devices if answers_when_powered(each)}
