"""A loaded controller with its lifecycle state and its schedule."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cellc.mock.control.controllers.base import Context, Controller

# A controller is updated when this share of its period has passed (tolerance for jitter in the real manager).
_DUE = 0.99


@dataclass(slots=True)
class LoadedController:
    """A controller in the manager.

    Attributes:
        name: name of the controller.
        type: its plugin type.
        controller: the controller.
        context: what it was given.
        state: lifecycle state.
        rate: its update rate (Hz).
        claims: command interfaces that it holds.
        columns: their columns.
        last_update_ns: time of its last update since activation.
        chained: whether a preceding controller writes its references.
    """

    name: str
    type: str
    controller: Controller
    context: Context
    state: str = "unconfigured"
    rate: int = 0
    claims: tuple[str, ...] = ()
    columns: NDArray[np.intp] = field(default_factory=lambda: np.empty(0, dtype=np.intp))
    last_update_ns: int | None = None
    chained: bool = False

    def is_due(self, time_ns: int, manager_rate: int) -> bool:
        """Whether it is updated in the cycle at a time."""
        if self.rate >= manager_rate or self.last_update_ns is None:
            return True
        return (time_ns - self.last_update_ns) / 1e9 * self.rate >= _DUE

    def divisor(self, manager_rate: int, period_ns: int) -> int:
        """Cycles of the manager from one update to the next."""
        if self.rate >= manager_rate:
            return 1
        cycles = 1
        while (cycles * period_ns) / 1e9 * self.rate < _DUE:
            cycles += 1
        return cycles

    def since_ns(self, time_ns: int, period_ns: int, manager_rate: int) -> int:
        """Time since its last update, its nominal period for the first."""
        if self.rate >= manager_rate:
            return period_ns
        return 1_000_000_000 // self.rate if self.last_update_ns is None else time_ns - self.last_update_ns
