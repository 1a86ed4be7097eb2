"""The action monitor: results and feedback reach the client on ticks of a timer that starts with the goal."""

from __future__ import annotations

from collections.abc import Callable

from cellc.mock.control.events import ControlEvent


class GoalMonitor:
    """Delivers the result of one goal, and its feedback to a listener.

    Args:
        goal_id: number of the goal.
        accepted_ns: when the goal was accepted, from which the timer runs.
        period_ns: period of the timer.
        listened: whether somebody listens to feedback.
    """

    def __init__(self, goal_id: int, accepted_ns: int, period_ns: int, listened: bool) -> None:
        self.goal_id = goal_id
        self.listened = listened
        self._accepted_ns = accepted_ns
        self._period_ns = period_ns
        self._last_tick_ns = accepted_ns
        self._result: Callable[[int], ControlEvent] | None = None
        self._decided_ns = 0
        self.canceling = False

    @property
    def decided(self) -> bool:
        """Whether the result is known and waits for delivery."""
        return self._result is not None

    def decide(self, now_ns: int, result: Callable[[int], ControlEvent]) -> None:
        """Note the result; `result` makes the event for the time of delivery."""
        self._result = result
        self._decided_ns = now_ns

    def next_ns(self) -> int | None:
        """The next tick on which there is something to deliver."""
        if self._result is None and not self.listened:
            return None
        earliest = max(self._decided_ns if self._result is not None else 0, self._last_tick_ns + 1)
        ticks = -((self._accepted_ns - earliest) // self._period_ns)
        return self._accepted_ns + max(ticks, 1) * self._period_ns

    def tick(self, now_ns: int) -> ControlEvent | None:
        """Take the result if it is known."""
        self._last_tick_ns = now_ns
        return None if self._result is None else self._result(now_ns)
