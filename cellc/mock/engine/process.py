"""The event queue on one integer clock of nanoseconds, and processes that wait on it.

A process is a generator that the simulation resumes at a signal, or at the bound of its wait.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Generator
from typing import TypeVar

from cellc.contract.frozen import dataclass

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
        """Return the time of the next event, or None."""
        return self._heap[0][0] if self._heap else None

    def pop_due(self, now_ns: int) -> Event | None:
        """Remove and return the next pending event at ``now_ns``, or None."""
        if self._heap and self._heap[0][0] <= now_ns:
            at_ns, _, action = heapq.heappop(self._heap)
            return Event(at_ns, action)
        return None


_Result = TypeVar("_Result")


class Signal:
    """Something that processes wait for; it carries no value, who wakes looks for itself.

    Attributes:
        from_background: it is fired by events of the background.
    """

    def __init__(self, *, from_background: bool = False) -> None:
        self.from_background = from_background
        self._waiting: list[tuple[Process, int]] = []

    def add(self, process: Process, wait_number: int) -> None:
        """Let a process be woken by the next firing; an earlier wait of the same process is over and forgotten."""
        self._waiting = [entry for entry in self._waiting if entry[0] is not process]
        self._waiting.append((process, wait_number))

    def fire(self, now_ns: int) -> None:
        """Wake everyone who waits, at the current instant and in the order in which they began to wait."""
        waiting, self._waiting = self._waiting, []
        for process, wait_number in waiting:
            process.wake(wait_number, now_ns)


@dataclass(frozen=True, slots=True)
class Wait:
    """A request of a process: resume me when one of the signals fires, at the latest at ``until_ns``.

    There is no wait without a bound, so that no missing responder can block the cell for ever.
    """

    until_ns: int
    signals: tuple[Signal, ...] = ()


Waiting = Generator[Wait, None, _Result]
"""What a function that waits returns: it yields waits and ends with a result."""


class Process:
    """Runs a generator of waits on an event queue; a wake that comes after another one already did is ignored.

    Attributes:
        finished: the body has ended.
        awaits_background: it waits for something that the background brings.
    """

    def __init__(self, queue: EventQueue, body: Waiting[None]) -> None:
        """Bind the process; it does not run before ``start``."""
        self.finished = False
        self.awaits_background = False
        self._queue = queue
        self._body = body
        self._wait_number = 0

    def start(self, now_ns: int) -> None:
        """Run the first part of the body at ``now_ns``."""
        self._queue.at(now_ns, self._resume)

    def wake(self, wait_number: int, at_ns: int) -> None:
        """Resume at ``at_ns`` unless the wait of this number is over by then."""
        self._queue.at(at_ns, lambda: self._resume_if(wait_number))

    def _resume_if(self, wait_number: int) -> None:
        if wait_number == self._wait_number:
            self._resume()

    def _resume(self) -> None:
        self._wait_number += 1
        try:
            wait = next(self._body)
        except StopIteration:
            self.finished = True
            return
        self.awaits_background = any(signal.from_background for signal in wait.signals)
        for signal in wait.signals:
            signal.add(self, self._wait_number)
        self.wake(self._wait_number, wait.until_ns)
