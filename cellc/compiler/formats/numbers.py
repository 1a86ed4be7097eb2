"""Numbers as files carry them: the shortest text that reads back to the same value."""

from __future__ import annotations

import math


def shortest(value: float) -> str:
    """Return the shortest text of a number for XML, where `1` and `1.0` are the same."""
    return repr(positive_zero(value)).removesuffix(".0")


def decimal(value: float) -> str:
    """Return the shortest text of a double for ROS parameters, which tell `1` from `1.0`.

    A text with an exponent gets a point too: YAML 1.1 reads `1e-05` as a string.
    """
    if math.isnan(value):
        return ".nan"
    if math.isinf(value):
        return ".inf" if value > 0 else "-.inf"
    mantissa, exponent, power = repr(positive_zero(value)).partition("e")
    return (mantissa if "." in mantissa else f"{mantissa}.0") + exponent + power


def at_most(bound: float) -> str:
    """Return an upper bound with two digits, never below it: a small change of what it follows from shows rarely."""
    step = 10.0 ** (math.floor(math.log10(bound)) - 1) if bound > 0.0 else 1.0
    return f"{math.ceil(round(bound / step, 6)) * step:.2g}"


def rounded(value: float) -> float:
    """Return a computed length or angle without its rounding noise: a picometer or picoradian is exact enough."""
    return positive_zero(round(value, 12))


def positive_zero(value: float) -> float:
    """Return the value as a float, zero without a sign."""
    return float(value) + 0.0
