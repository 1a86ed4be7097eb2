"""How a joint differs from one that follows its command immediately and is measured exactly.

Every effect that a fault may have on a joint is a field of ``JointFault``, and acts here alone: on where the joint goes
(``follow``) or on what is measured (``measured``). The hardware of a controller manager and the device behind an
adapter both call these two.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.mock.control.hardware.joint_motion import Noise, rate_limit
from cellc.mock.control.interfaces import Array


@dataclass(frozen=True, slots=True)
class JointFault:
    """What is wrong with a joint, or how a healthy one is by nature.

    Attributes:
        stuck: the joint does not move at all.
        max_velocity: rad/s or m/s that the joint cannot exceed.
        time_constant_s: of a first-order lag behind the command; 0 for none.
        offset: rad or m added to the position.
        lower: the joint is blocked below this position, rad or m.
        upper: the joint is blocked above this position, rad or m.
        noise: of its measured position.
    """

    stuck: bool = False
    max_velocity: float = math.inf
    time_constant_s: float = 0.0
    offset: float = 0.0
    lower: float = -math.inf
    upper: float = math.inf
    noise: Noise | None = None

    def __and__(self, other: JointFault) -> JointFault:
        """Return both together: of two bounds or lags the one that restrains more; offsets add up."""
        return JointFault(
            stuck=self.stuck or other.stuck,
            max_velocity=min(self.max_velocity, other.max_velocity),
            time_constant_s=max(self.time_constant_s, other.time_constant_s),
            offset=self.offset + other.offset,
            lower=max(self.lower, other.lower),
            upper=min(self.upper, other.upper),
            noise=other.noise or self.noise,
        )

    def follow(self, wanted: Array, previous: float, period_s: float) -> Array:
        """Return the positions that the joint really takes.

        Args:
            wanted: positions that it would take in successive cycles, rad or m.
            previous: its position before.
            period_s: time between two cycles.
        """
        if self.stuck:
            return np.full_like(wanted, previous)
        if len(wanted) > 1 and self.time_constant_s > 0.0 and self._is_bounded:
            return self._follow_singly(wanted, previous, period_s)
        moved = wanted + self.offset
        if self.time_constant_s > 0.0:
            moved = _lag(moved, previous, period_s / (self.time_constant_s + period_s))
        if math.isfinite(self.max_velocity):
            moved, _ = rate_limit(moved, previous, self.max_velocity * period_s, self.lower, self.upper)
        return np.minimum(np.maximum(moved, self.lower), self.upper)

    def measured(self, positions: Array, first_cycle: int) -> Array:
        """Return what is measured of a joint's positions in successive cycles, rad or m.

        Args:
            positions: where the joint really is.
            first_cycle: number of the first cycle.
        """
        if self.noise is None:
            return positions
        return positions + self.noise.values(first_cycle, len(positions))

    @property
    def integrated(self) -> JointFault:
        """The same of a joint whose position is the integral of a commanded velocity: without offset and lag."""
        return replace(self, offset=0.0, time_constant_s=0.0)

    @property
    def _is_bounded(self) -> bool:
        return math.isfinite(self.max_velocity) or math.isfinite(self.lower) or math.isfinite(self.upper)

    def _follow_singly(self, wanted: Array, previous: float, period_s: float) -> Array:
        """Follow cycle by cycle: the lag of each begins where a bound left the joint in the one before."""
        moved = np.empty_like(wanted)
        for cycle in range(len(wanted)):
            moved[cycle : cycle + 1] = self.follow(wanted[cycle : cycle + 1], previous, period_s)
            previous = float(moved[cycle])
        return moved


def _lag(wanted: Array, previous: float, share: float) -> Array:
    """First-order lag, each value a `share` of the way nearer to the wanted one."""
    lagged = wanted.tolist()
    for index, value in enumerate(lagged):
        previous = previous + share * (value - previous)
        lagged[index] = previous
    return np.array(lagged)


class JointFaults:
    """What is wrong with each joint now; several causes may act on one joint, and each ends by itself."""

    def __init__(self) -> None:
        self._causes: dict[str, list[JointFault]] = {}
        self._together: dict[str, JointFault] = {}

    def __bool__(self) -> bool:
        """Return whether anything is wrong with any joint."""
        return bool(self._together)

    def of(self, joint: str) -> JointFault | None:
        """Return everything that is wrong with a joint, None where nothing is."""
        return self._together.get(joint)

    def add(self, joint: str, fault: JointFault) -> None:
        """Let something be wrong with a joint from now on."""
        self._causes.setdefault(joint, []).append(fault)
        self._combine(joint)

    def remove(self, joint: str, fault: JointFault) -> None:
        """Let one cause be over; nothing happens where it does not act."""
        if fault in self._causes.get(joint, ()):
            self._causes[joint].remove(fault)
            self._combine(joint)

    def _combine(self, joint: str) -> None:
        self._together.pop(joint, None)
        for fault in self._causes[joint]:
            before = self._together.get(joint)
            self._together[joint] = fault if before is None else before & fault
