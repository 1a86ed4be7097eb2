"""The loop: run the control stack up to the next event, then the event, until the process that matters has ended."""

from __future__ import annotations

from collections.abc import Callable

from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.process import Process, Waiting
from cellc.mock.engine.queue import Action, EventQueue


class Simulation:
    """One simulated clock over the event queue and the control stack; no threads, no sleep, no wall clock."""

    def __init__(self, control: ControlStack) -> None:
        """Bind the simulation at the time of the control stack."""
        self.control = control
        self.now_ns = 0
        self._queue = EventQueue()

    def at(self, when_ns: int, action: Action) -> None:
        """Schedule an action; a time in the past means the current instant."""
        self._queue.at(max(when_ns, self.now_ns), action)

    def every(self, first_ns: int, rate_hz: float, action: Callable[[int], None]) -> None:
        """Call ``action`` with 0, 1, 2 … at ``first_ns + k / rate_hz``, without drift."""

        def fire(index: int) -> None:
            self.at(first_ns + round((index + 1) * 1e9 / rate_hz), lambda: fire(index + 1))
            action(index)

        self.at(first_ns, lambda: fire(0))

    def run_process(self, body: Waiting[None]) -> None:
        """Run a process to its end; everything else in the cell goes on meanwhile."""
        process = Process(self._queue, body)
        process.start(self.now_ns)
        while not process.finished:
            self._step()

    def _step(self) -> None:
        target_ns = self._queue.next_ns()
        if target_ns is None:
            raise RuntimeError("a process waits and nothing is scheduled")
        while self.now_ns < target_ns:
            self.now_ns = self.control.advance(target_ns)
            self.control.dispatch(self.now_ns)
            target_ns = min(target_ns, self._queue.next_ns() or target_ns)
        action = self._queue.pop_due(self.now_ns)
        if action is not None:
            action()
            self.control.dispatch(self.now_ns)
