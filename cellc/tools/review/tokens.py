"""A line of text as words and figures: order, spacing and spelling of units do not tell two lines apart."""

from __future__ import annotations

import math
import re

from cellc.compiler.spec import quantity

_DIMENSIONS = tuple(var for var in vars(quantity).values() if isinstance(var, quantity.Dimension))
_FACTORS = {
    unit: math.radians(1.0) if factor is None else float(factor)
    for dimension in _DIMENSIONS
    for unit, factor in dimension.units
}
_UNITS = "|".join(re.escape(unit) for unit in sorted(_FACTORS, key=len, reverse=True))
# Bounded, so that an untrusted line costs no square.
_NUMBER = r"[-+]?(?:[0-9]{1,30}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][-+]?[0-9]{1,3})?"
_TOKEN = re.compile(
    rf"(?<![\w.+-])(?P<number>{_NUMBER})(?:(?P<unit>{_UNITS})(?![\w/^]))?(?![\w.]{{0,30}}\w)"
    r"|(?P<word>[^\W\d_][\w./:@^-]*\w|[\w/~][\w./:@-]*|\S)"
)
_IGNORED = frozenset(";|`'\"()[]{}<>=*")


def tokens(line: str) -> tuple[str, ...]:
    """Return the words of a line, sorted, with quantities in SI and without punctuation."""
    result: list[str] = []
    waiting: list[float] = []  # figures, until the unit behind the last of them is seen
    for match in _TOKEN.finditer(line):
        if match["number"]:
            waiting.append(float(match["number"]))
        word = match["unit"] or match["word"]
        if word == "," or word is None:
            continue
        factor = _FACTORS.get(word) if waiting else None
        result += (_figure(value * (1.0 if factor is None else factor)) for value in waiting)
        waiting.clear()
        if factor is None and word not in _IGNORED:
            result.append(word)
    result += map(_figure, waiting)
    return tuple(sorted(result))


def _figure(value: float) -> str:
    return "0" if abs(value) <= 1e-12 else f"{value:.7g}"
