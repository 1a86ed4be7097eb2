"""Markdown of ours as it is read at a terminal: no line is wider, and a row that would be is a list of its cells."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from textwrap import wrap

from cellc.contract.diagnostics.wording import aligned
from cellc.contract.folding import LEAST
from cellc.contract.printing import columns, show, show_document


def show_markdown(text: str) -> None:
    """Print a document: as it is for a file or another program, and in the form of a terminal on one."""
    wide = columns(0)
    if wide:
        show(*terminal_form(text, max(wide, LEAST)))
    else:
        show_document(text)


def terminal_form(text: str, wide: int) -> Iterator[str]:
    """Yield the lines of a document for a terminal of so many columns; what is in a fence is left alone."""
    fenced = False
    for is_row, lines in groupby(text.removesuffix("\n").split("\n"), key=lambda line: line.startswith("|")):
        if is_row and not fenced:
            yield from _table([_cells(line) for line in lines], wide)
            continue
        for line in lines:
            fenced ^= line.startswith("```")
            yield from [line] if fenced or line.startswith("```") else _folded(line, wide)


def _cells(line: str) -> list[str]:
    cells = re.split(r"(?<!\\)\|", line.strip()[1:-1])
    return [cell.strip().replace("\\|", "|").replace("<br>", "; ") for cell in cells]


def _table(rows: Sequence[Sequence[str]], wide: int) -> Iterator[str]:
    head, *others = [row for row in rows if set("".join(row)) - set("-: ")] or [[]]
    lines = aligned((head, *others)) if all(len(row) == len(head) for row in others) else []
    if lines and max(map(len, lines)) <= wide:
        yield from lines
        return
    for row in others:
        yield from _folded(f"{head[0]}: {row[0]}", wide)
        for name, cell in zip(head[1:], row[1:], strict=False):
            yield from wrap(f"{name}: {cell}", wide, initial_indent="    ", subsequent_indent="      ") if cell else ()


def _folded(line: str, wide: int) -> Sequence[str]:
    """Return a line in several where it is too wide; what follows the sign of a list is below its text."""
    if len(line) <= wide:
        return [line]
    sign = re.match(r" *(?:[-*] |\d+\. )?", line)
    return wrap(line, wide, subsequent_indent=" " * (sign.end() if sign else 0), break_on_hyphens=False) or [line]
