"""Signals over any length of time in bounded memory, without losing an extreme value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Times = NDArray[np.int64]

_SLOTS = 1024
FIRST_WIDTH_NS = 10_000_000
"""Length of a slot at first; what changes more slowly should be added as often."""


@dataclass(frozen=True, slots=True)
class Envelope:
    """Least and greatest value of some signals in each slot of time.

    Attributes:
        width_ns: length of a slot.
        starts_ns: begin of each slot that has a value, shape (n,).
        lowest: least values, shape (n, signals); NaN where a signal had none.
        highest: greatest values, the same way.
    """

    width_ns: int
    starts_ns: Times
    lowest: Array
    highest: Array


class EnvelopeBuilder:
    """Adds samples to slots; when they do not fit any more, each two neighbouring slots become one."""

    def __init__(self, signals: int) -> None:
        self._width_ns = FIRST_WIDTH_NS
        self._lowest: Array = np.full((_SLOTS, signals), np.nan)
        self._highest: Array = np.full((_SLOTS, signals), np.nan)

    def add(self, times_ns: Times, values: Array) -> None:
        """Add samples at times from 0 on, shape (samples, signals)."""
        if not len(times_ns):
            return
        while int(times_ns.max()) // self._width_ns >= _SLOTS:
            self._widen()
        slots = times_ns // self._width_ns
        np.fmin.at(self._lowest, slots, values)
        np.fmax.at(self._highest, slots, values)

    def envelope(self) -> Envelope:
        """Return the slots that have a value."""
        used = np.flatnonzero(~np.isnan(self._lowest).all(axis=1))
        starts: Times = used.astype(np.int64) * self._width_ns
        return Envelope(self._width_ns, starts, self._lowest[used], self._highest[used])

    def _widen(self) -> None:
        self._width_ns *= 2
        empty = np.full((_SLOTS // 2, self._lowest.shape[1]), np.nan)
        self._lowest = np.concatenate([np.fmin(self._lowest[0::2], self._lowest[1::2]), empty])
        self._highest = np.concatenate([np.fmax(self._highest[0::2], self._highest[1::2]), empty])
