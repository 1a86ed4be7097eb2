"""From values to places in a drawing, and the round values that an axis shows."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Scale:
    """Maps ``low`` … ``high`` linearly to ``start`` … ``end``."""

    low: float
    high: float
    start: float
    end: float

    def place(self, value: float) -> float:
        """Return the place of a value."""
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)


def ticks(low: float, high: float, most: int) -> list[float]:
    """Return round values inside a range: steps of 1, 2 or 5 times a power of ten."""
    raw = (high - low) / most
    magnitude = 10.0 ** math.floor(math.log10(raw))
    step = next(factor * magnitude for factor in (1.0, 2.0, 5.0, 10.0) if factor * magnitude >= raw * (1.0 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [index * step for index in range(first, last + 1)]


def round_below(value: float) -> float:
    """Return the greatest of 1, 2 and 5 times a power of ten that is not above a value."""
    magnitude = 10.0 ** math.floor(math.log10(value))
    return next(factor * magnitude for factor in (5.0, 2.0, 1.0) if factor * magnitude <= value * (1.0 + 1e-9))


def padded(low: float, high: float, least: float) -> tuple[float, float]:
    """Return a range with a margin of an eighth, and at least ``least`` wide."""
    half = max((high - low) * 0.625, least / 2.0)
    middle = (low + high) / 2.0
    return middle - half, middle + half
