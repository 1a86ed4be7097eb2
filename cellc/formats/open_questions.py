"""What nobody has answered yet: every UNKNOWN of the spec, with the place that waits for the answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.diagnostics import YamlPath
from cellc.formats.version_tuple import version_tuple
from cellc.graph.cell_graph import CellGraph
from cellc.graph.responsibilities import UNKNOWN


@dataclass(frozen=True, slots=True)
class OpenQuestion:
    """One UNKNOWN: what is not known, and where the answer belongs."""

    subject: str
    path: YamlPath


def open_questions(graph: CellGraph) -> tuple[OpenQuestion, ...]:
    """Return the questions that block the real target, versions first."""
    return (*_versions(graph.cell), *_owners(graph), *_safety(graph.cell))


def _versions(cell: Cell) -> Iterator[OpenQuestion]:
    for name, value in version_tuple(cell).items():
        if value == UNKNOWN:
            of, _, part = name.rpartition(".")
            device = of in {device.name for device in cell.devices}
            path = ("devices", of, part) if device else ("versions", *name.split("."))
            yield OpenQuestion(f"{part} of {of}" if of else name, path)


def _owners(graph: CellGraph) -> Iterator[OpenQuestion]:
    for item in graph.responsibilities.items:
        if item.open:
            yield OpenQuestion(f"owner of {item.kind} {item.name}", item.path)


def _safety(cell: Cell) -> Iterator[OpenQuestion]:
    stop = cell.spec.safety.stop
    for name, value in (("authority", stop.authority), ("path", stop.path)):
        if value == UNKNOWN:
            yield OpenQuestion(f"stop {name}", ("safety", "stop", name))
