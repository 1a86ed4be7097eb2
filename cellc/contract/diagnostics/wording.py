"""Texts that commands and pages make alike: columns of a terminal, numbers with their nouns, and how long it takes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator


def aligned(rows: Iterable[Iterable[str]], wide: int = 0) -> list[str]:
    """Return a line for each row, the columns below each other with two blanks between, and none at the end.

    Args:
        rows: of one length; the first may name the columns.
        wide: columns of a terminal; where a row is wider, a long first cell is above the others. Zero for a file.
    """
    table = [tuple(row) for row in rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in table]
    if not wide or max(map(len, lines), default=0) <= wide:
        return lines
    others = aligned(row[1:] for row in table)
    room = wide - max(map(len, others)) - 2
    lead = room if room >= _LEAST_LEAD else 2
    return [line for row, rest in zip(table, others, strict=True) for line in _led(row[0], rest, lead)]


_LEAST_LEAD = 12


def _led(name: str, rest: str, lead: int) -> Iterator[str]:
    if len(name) > lead:
        yield name
    yield f"{name if len(name) <= lead else '':<{lead}}  {rest}".rstrip()


def count(number: int, noun: str) -> str:
    """Return a number with its noun, in the plural where there are several."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


_MINUTES_FROM_S = 120.0


def time_left(done: int, total: int, seconds: float) -> str:
    """Return how long the rest takes at the pace so far, such as ``, 40 s left``; empty where nothing is done.

    Args:
        seconds: in which as many as are done were done.
    """
    if not done:
        return ""
    left_s = (total - done) * max(seconds, 1e-3) / done
    return f", {left_s / 60:.0f} min left" if left_s >= _MINUTES_FROM_S else f", {left_s:.0f} s left"


def both(value: float, bound: float) -> tuple[str, str]:
    """Return two figures that are compared: with as many digits, and enough to see which is larger."""
    texts = ("", "")
    for digits in range(3, 10):
        texts = (f"{value:.{digits}f}", f"{bound:.{digits}f}")
        if texts[0] != texts[1]:
            break
    return texts


def percent(share: float) -> str:
    """Return a share of 1 in percent, with at most four digits and no zero at the end."""
    return f"{100.0 * share:.4g} %"
