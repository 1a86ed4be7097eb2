"""Tables of Markdown whose cells are texts of anybody."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cellc.compiler.formats.escape import markdown
from cellc.contract.frozen import dataclass


@dataclass(frozen=True, slots=True)
class Link:
    """A link to a file of ours."""

    text: str
    target: str


TableCell = str | Link | Sequence[str]
"""One line of prose, a link, or several lines that stand below each other."""


def table(head: Sequence[str], rows: Iterable[Sequence[TableCell]]) -> str:
    """Write a table; a sentence where it has no row, so that an empty section is an answer."""
    shown = [_row(row) for row in rows]
    return "\n".join([_row(head), "|" + "---|" * len(head), *shown]) if shown else "None."


def _row(cells: Sequence[TableCell]) -> str:
    # A bar would end the cell.
    return f"| {' | '.join(_text(cell).replace('|', chr(92) + '|') for cell in cells)} |"


def _text(cell: TableCell) -> str:
    if isinstance(cell, Link):
        return f"[{markdown(cell.text)}]({cell.target})"
    return markdown(cell) if isinstance(cell, str) else "<br>".join(map(markdown, cell))
