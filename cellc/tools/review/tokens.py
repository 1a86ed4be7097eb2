"""A line of text as words and figures: spacing, spelling of units and order of words do not tell two lines apart.

The order of figures does: those that stand together, such as a vector, are one token behind the word before them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence

from cellc.compiler.spec import quantity

_DIMENSIONS = tuple(var for var in vars(quantity).values() if isinstance(var, quantity.Dimension))
UNITS: Mapping[str, tuple[str, float]] = {
    unit: (dimension.name, math.radians(1.0) if factor is None else float(factor))
    for dimension in _DIMENSIONS
    for unit, factor in dimension.units
}
"""What each unit measures, and its factor to SI."""
_FACTORS = {unit: factor for unit, (_, factor) in UNITS.items()}
_UNITS = "|".join(re.escape(unit) for unit in sorted(_FACTORS, key=len, reverse=True))
# Bounded, so that an untrusted line costs no square.
_NUMBER = r"[-+]?(?:[0-9]{1,30}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][-+]?[0-9]{1,3})?"
_TOKEN = re.compile(
    rf"(?<![\w.+-])(?P<number>{_NUMBER})(?:(?P<unit>{_UNITS})(?![\w/^]))?(?![\w.]{{0,30}}\w)"
    r"|(?P<word>[^\W\d_][\w./:@^-]*\w|[\w/~][\w./:@-]*|\S)"
)
_IGNORED = frozenset(";|`'\"()[]{}<>=*")
_BETWEEN = " "
"""What no word has in it."""


def tokens(line: str) -> tuple[str, ...]:
    """Return the words and figures of a line, sorted, with quantities in SI and without punctuation."""
    return tuple(sorted(part for token in _tokens(line) for part in parts(token)))


def ordered(line: str) -> tuple[str, ...]:
    """Return the same with figures that stand together as one token, in their order behind the word before them."""
    return tuple(sorted(_tokens(line)))


def parts(token: str) -> Sequence[str]:
    """Return a word itself, and of figures each, without the word before them."""
    return token.split(_BETWEEN)[1:] if _BETWEEN in token else (token,)


def holder(token: str) -> str | None:
    """Return the word before figures; None for a word."""
    return token.partition(_BETWEEN)[0] if _BETWEEN in token else None


def _tokens(line: str) -> Iterator[str]:
    before, run = "", list[str]()
    waiting: list[float] = []  # figures, until the unit behind the last of them is seen
    for match in _TOKEN.finditer(line):
        if match["number"]:
            waiting.append(float(match["number"]))
        word = match["unit"] or match["word"]
        if word == "," or word is None:
            continue
        factor = _FACTORS.get(word) if waiting else None
        run += (_figure(value * (1.0 if factor is None else factor)) for value in waiting)
        waiting.clear()
        if factor is not None or word in _IGNORED:
            continue
        if word[0].isdigit():
            run.append(word)  # an address, a version or a date
            continue
        yield from _bound(before, run)
        run, before = [], word
        yield word
    yield from _bound(before, [*run, *map(_figure, waiting)])


def _bound(before: str, run: Sequence[str]) -> Sequence[str]:
    return [_BETWEEN.join((before, *run))] if run else []


def _figure(value: float) -> str:
    return "0" if abs(value) <= 1e-12 else f"{value:.7g}"
