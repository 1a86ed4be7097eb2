"""The event queue: what happens when, on one integer clock of nanoseconds."""

from __future__ import annotations

import heapq
from collections.abc import Callable
from dataclasses import dataclass

Action = Callable[[], None]


@dataclass(frozen=True, slots=True)
class Event:
    """An action with the time that it was scheduled for."""

    at_ns: int
    run: Action


class EventQueue:
    """Events in order of time; ties are decided by the order of scheduling, so every run is the same."""

    def __init__(self) -> None:
        self._heap: list[tuple[int, int, Action]] = []
        self._sequence = 0

    def at(self, when_ns: int, action: Action) -> None:
        """Schedule an action at a time in nanoseconds."""
        heapq.heappush(self._heap, (when_ns, self._sequence, action))
        self._sequence += 1

    def next_ns(self) -> int | None:
        """Return the time of the next event; None where there is none."""
        return self._heap[0][0] if self._heap else None

    def pop_due(self, now_ns: int) -> Event | None:
        """Remove and return the next event that is due at ``now_ns``; None where there is none."""
        if self._heap and self._heap[0][0] <= now_ns:
            at_ns, _, action = heapq.heappop(self._heap)
            return Event(at_ns, action)
        return None
