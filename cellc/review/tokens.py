"""A line of text as words and figures: order, spacing and spelling of units do not tell two lines apart."""

from __future__ import annotations

import math
import re
from collections import Counter

from cellc.spec import quantity

_DIMENSIONS = tuple(one for one in vars(quantity).values() if isinstance(one, quantity.Dimension))
_FACTORS = {
    unit: math.radians(1.0) if factor is None else float(factor)
    for dimension in _DIMENSIONS
    for unit, factor in dimension.units
}
_UNITS = "|".join(re.escape(unit) for unit in sorted(_FACTORS, key=len, reverse=True))
# Bounded, so that a line of a stranger costs no square.
_NUMBER = r"[-+]?(?:[0-9]{1,30}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][-+]?[0-9]{1,3})?"
_WORD = re.compile(
    rf"(?<![\w.+-])(?P<numbers>{_NUMBER}(?:[ ,]{{1,3}}{_NUMBER}){{0,31}})[ ]?(?P<unit>{_UNITS})(?![\w/^])"
    rf"|(?<![\w.+-])(?P<number>{_NUMBER})(?![\w.]{{0,30}}\w)"
    r"|(?P<word>[^\W\d_][\w./:@-]*\w|[\w/~][\w./:@-]*|\S)"
)
_IGNORED = frozenset(",;|`'\"()[]{}<>=*")


def tokens(line: str) -> tuple[str, ...]:
    """Return the words of a line, sorted, with quantities in SI and without punctuation."""
    found: Counter[str] = Counter()
    for match in _WORD.finditer(line):
        if match["unit"]:
            factor = _FACTORS[match["unit"]]
            found.update(_figure(float(one) * factor) for one in re.split("[ ,]+", match["numbers"]))
        elif match["number"]:
            found[_figure(float(match["number"]))] += 1
        elif match["word"] not in _IGNORED:
            found[match["word"]] += 1
    return tuple(sorted(found.elements()))


def _figure(value: float) -> str:
    return "0" if abs(value) <= 1e-12 else f"{value:.7g}"
