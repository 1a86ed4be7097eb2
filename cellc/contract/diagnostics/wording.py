"""Texts that commands and pages make alike: columns of a terminal, and numbers with their nouns."""

from __future__ import annotations

from collections.abc import Iterable


def aligned(rows: Iterable[Iterable[str]]) -> list[str]:
    """Return a line for each row, the columns below each other with two blanks between, and none at the end.

    Args:
        rows: of one length; the first may name the columns.
    """
    table = [tuple(row) for row in rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in table]


def count(number: int, noun: str) -> str:
    """Return a number with its noun, in the plural where there are several."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
