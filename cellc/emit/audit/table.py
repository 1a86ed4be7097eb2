"""Tables of Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a table; a sentence where it has no row, so that an empty section is an answer."""
    shown = [_row(row) for row in rows]
    return "\n".join([_row(head), "|" + "---|" * len(head), *shown]) if shown else "None."


def _row(cells: Sequence[str]) -> str:
    # A bar would end the cell.
    escaped = (cell.replace("|", "\\|").replace("\n", " ") for cell in cells)
    return f"| {' | '.join(escaped)} |"
