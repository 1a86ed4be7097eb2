"""When the joints of a goal were first driven, and when they were held after a cancel, from joint states alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

MOVED = 1e-9
"""rad or m: the least change of a joint that counts as having been driven."""
_MOST_PERIODS = 3
"""Between two joint states, of the shortest that was seen, without one being missed."""
STANDSTILL = 1e-3
"""rad/s or m/s below which a joint is held."""


@dataclass(slots=True)
class Motion:
    """Follows the joints of one goal.

    Attributes:
        joints: that the goal moves.
        accepted_ns: when the goal was accepted.
        driven_ns: first stamp at which a joint is elsewhere than at acceptance; None where none moved.
        held_ns: first stamp from the cancel on from which all are at standstill; None where they are not.
    """

    joints: tuple[str, ...]
    accepted_ns: int
    driven_ns: int | None = None
    held_ns: int | None = None
    _start: dict[str, float] = field(default_factory=dict)
    _last: dict[str, tuple[int, float]] = field(default_factory=dict)
    _canceled_ns: int | None = None
    _shortest_ns: int = 0
    _has_gap: bool = False

    @property
    def is_canceled(self) -> bool:
        """Tell whether the standstill after a cancel is looked for still."""
        return self._canceled_ns is not None and self.held_ns is None and not self._has_gap

    def begin(self, positions: Mapping[str, float], stamps_ns: Mapping[str, int]) -> None:
        """Take where joints are as the goal is accepted, and since when that is known."""
        self._start = {joint: positions[joint] for joint in self.joints if joint in positions}
        self._last = {joint: (stamps_ns[joint], at) for joint, at in self._start.items() if joint in stamps_ns}

    def cancel(self, at_ns: int) -> None:
        """Look from now on for the standstill; what was heard before may be old."""
        self._canceled_ns = at_ns

    def move(self, stamp_ns: int, positions: Mapping[str, float]) -> None:
        """Take a joint state."""
        mine = {joint: positions[joint] for joint in self.joints if joint in positions}
        if not mine:
            return
        if stamp_ns <= self.accepted_ns:
            self._start |= mine
        elif self.driven_ns is None and any(abs(at - self._start.get(joint, at)) > MOVED for joint, at in mine.items()):
            self.driven_ns = stamp_ns
        is_still = self._speed(stamp_ns, mine) <= STANDSTILL
        before_ns = min((self._last[joint][0] for joint in mine if joint in self._last), default=stamp_ns)
        self._last |= {joint: (stamp_ns, at) for joint, at in mine.items()}
        if stamp_ns > before_ns:
            self._shortest_ns = min(stamp_ns - before_ns, self._shortest_ns or stamp_ns - before_ns)
        if self.is_canceled and self._canceled_ns is not None and stamp_ns > self._canceled_ns:
            # Where states are missing around the request, the instant of the standstill is in none of them.
            self._has_gap = stamp_ns - before_ns > _MOST_PERIODS * self._shortest_ns > 0
            if is_still and not self._has_gap:
                self.held_ns = max(self._canceled_ns, before_ns)

    def _speed(self, stamp_ns: int, positions: Mapping[str, float]) -> float:
        """Return the largest speed of a joint since its last state."""
        speeds = [
            abs(at - self._last[joint][1]) / max((stamp_ns - self._last[joint][0]) / 1e9, 1e-9)
            for joint, at in positions.items()
            if joint in self._last
        ]
        return max(speeds, default=0.0)
