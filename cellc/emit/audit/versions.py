"""The exact tuple, with what a matrix says of each part."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.emit.audit.table import table
from cellc.graph.compatibility import compatibility


def version_section(cell: Cell) -> str:
    """Write the tuple as a table."""
    return table(("of", "part", "pinned", "answer", "because"), _rows(cell))


def _rows(cell: Cell) -> Iterator[tuple[str, ...]]:
    for judged in compatibility(cell):
        yield judged.pin.holder, judged.pin.part, judged.pin.text, judged.answer.value, judged.evidence
