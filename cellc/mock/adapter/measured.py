"""Where joints behind springs are while the device of an adapter leads them: what its state says."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from cellc.contract.control_law import ControlLaw
from cellc.contract.vocabulary import Held
from cellc.mock.control.hardware.spring_joints import SpringJoints
from cellc.mock.control.interfaces import Array
from cellc.robot.planning import Springs

Led = Callable[[int], tuple[float, ...]]
"""Where the device leads its joints at a time, rad or m."""


class MeasuredMotion:
    """Joints that follow where they are led, period by period.

    Args:
        law: of the device.
        springs: bound to its robot and its load.
        names: joints of the device, in its order.
        positions: of the same joints now, rad or m.
        period_ns: of states.
    """

    def __init__(
        self,
        law: ControlLaw,
        springs: Springs,
        names: tuple[str, ...],
        positions: tuple[float, ...],
        period_ns: int,
        now_ns: int,
    ) -> None:
        self.positions = positions
        self.velocities = (0.0,) * len(positions)
        self.holds_measured = law.held is Held.MEASURED
        self._springs = SpringJoints(law, springs, names, np.array(positions))
        self._columns = np.arange(len(names), dtype=np.intp)
        self._period_ns = period_ns
        self._reached_ns = now_ns

    @property
    def settled(self) -> bool:
        """Whether nothing moves until the joints are led elsewhere."""
        return self._springs.settled

    def load(self, springs: Springs) -> None:
        """Let the joints hold another load from now on."""
        self._springs.load(springs)

    def rest(self, positions: tuple[float, ...], now_ns: int) -> None:
        """Let the joints begin again from where they are."""
        self.positions, self.velocities = positions, (0.0,) * len(positions)
        self._springs.rest(np.array(positions))
        self._reached_ns = now_ns

    def advance(self, until_ns: int, led: Led, *, leads: bool) -> None:
        """Compute the periods up to a time; none where joints that have settled are not led elsewhere."""
        periods = (until_ns - self._reached_ns) // self._period_ns
        if periods <= 0:
            return
        first_ns = self._reached_ns + self._period_ns
        self._reached_ns += periods * self._period_ns
        if self.settled and not leads:
            self.velocities = (0.0,) * len(self.positions)
            return
        rows: Array = np.array([led(first_ns + period * self._period_ns) for period in range(periods)])
        self._springs.follow(self._columns, rows, first_ns // self._period_ns, self._period_ns / 1e9)
        self._springs.commit(periods)
        before = rows[-2] if periods > 1 else np.array(self.positions)
        self.velocities = tuple(((rows[-1] - before) / (self._period_ns / 1e9)).tolist())
        self.positions = tuple(rows[-1].tolist())
