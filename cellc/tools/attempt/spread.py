"""Figures of any number of values in bounded memory: their count, extremes, and quantiles of an even choice of them."""

from __future__ import annotations

from dataclasses import dataclass, field

_MOST = 4096


@dataclass(slots=True)
class Spread:
    """Takes values; beyond 4096 every second, fourth, … one is kept, the same ones for the same values."""

    count: int = 0
    least: float = float("inf")
    most: float = float("-inf")
    _kept: list[float] = field(default_factory=list)
    _stride: int = 1

    def add(self, value: float) -> None:
        """Take a value; what is no number counts for nothing."""
        if value != value:
            return
        if self.count % self._stride == 0:
            self._kept.append(value)
            if len(self._kept) > _MOST:
                self._kept = self._kept[::2]
                self._stride *= 2
        self.count += 1
        self.least = min(self.least, value)
        self.most = max(self.most, value)

    @property
    def median(self) -> float:
        """The middle one of the values; that of two which is larger."""
        return sorted(self._kept)[len(self._kept) // 2]
