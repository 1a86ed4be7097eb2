"""The event queue: what happens when, on one integer clock of nanoseconds."""

from __future__ import annotations

import heapq
from collections.abc import Callable
from dataclasses import dataclass, field

Action = Callable[[], None]


@dataclass(order=True, slots=True)
class _Entry:
    at_ns: int
    sequence: int  # events of one instant run in the order in which they were scheduled
    action: Action = field(compare=False)


class EventQueue:
    """Events in order of time; ties are decided by the order of scheduling, so every run is the same."""

    def __init__(self) -> None:
        self._heap: list[_Entry] = []
        self._sequence = 0

    def at(self, when_ns: int, action: Action) -> None:
        """Schedule an action at a time in nanoseconds."""
        heapq.heappush(self._heap, _Entry(when_ns, self._sequence, action))
        self._sequence += 1

    def next_ns(self) -> int | None:
        """Return the time of the next event; None where there is none."""
        return self._heap[0].at_ns if self._heap else None

    def pop_due(self, now_ns: int) -> Action | None:
        """Remove and return the next action that is due at ``now_ns``; None where there is none."""
        if self._heap and self._heap[0].at_ns <= now_ns:
            return heapq.heappop(self._heap).action
        return None
