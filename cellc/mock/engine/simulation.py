"""The loop: run the control stack up to the next event, then the event, until the process that matters has ended."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from cellc.contract.limits import limits
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.process import Action, EventQueue, Process, Waiting
from cellc.mock.errors import LimitReachedError

_MAX_STEPS_AT_ONCE = 100_000


class Simulation:
    """One simulated clock over the control stack and two event queues; no threads, no sleep, no wall clock.

    Events of the foreground touch the control stack, so it is advanced to their time first. Events of the background, a
    camera's images for instance, never do: they run at their own times once the control stack has passed them, and
    before anything in the foreground that comes later. So the control stack runs in long blocks. Only while a process
    waits for what the background brings does it stop at every background event too.

    Attributes:
        heard_outside: somebody outside hears the cell as it runs, so that the control stack may not run ahead.
    """

    def __init__(self, control: ControlStack) -> None:
        """Bind the simulation at the time of the control stack."""
        self.control = control
        self.heard_outside = False
        self.now_ns = 0
        self._last_ns = 0
        self._steps_at_once = 0
        self._events = 0
        self._most_events = limits().mock_events
        self._foreground = EventQueue()
        self._background = EventQueue()

    def at(self, when_ns: int, action: Action) -> None:
        """Schedule an action of the foreground; a time in the past means the current instant."""
        self._foreground.at(max(when_ns, self.now_ns), action)

    def at_background(self, when_ns: int, action: Action) -> None:
        """Schedule an action that neither reads nor commands the present state of the control stack."""
        self._background.at(max(when_ns, self.now_ns), action)

    @property
    def events(self) -> int:
        """Events that have happened."""
        return self._events

    def catch_up(self, until_ns: int, events: int | None = None) -> None:
        """Let time pass in the background up to where the control stack is, or before.

        Args:
            events: that have happened by then, where some are not done again.
        """
        self._run_background(until_ns)
        self.now_ns = self._last_ns = until_ns
        self._events = self._events if events is None else events

    def next_foreground_ns(self) -> int | None:
        """Return the time of the next event of the foreground, or None."""
        return self._foreground.next_ns()

    def every(self, first_ns: int, rate_hz: float, action: Callable[[int], None]) -> None:
        """Call ``action`` in the background with 0, 1, 2 … at ``first_ns + k / rate_hz``, without drift."""

        def fire(index: int) -> None:
            self.at_background(first_ns + round((index + 1) * 1e9 / rate_hz), partial(fire, index + 1))
            action(index)

        self.at_background(first_ns, partial(fire, 0))

    def run_process(self, body: Waiting[None]) -> None:
        """Run a process to its end; everything else in the cell goes on meanwhile."""
        process = Process(self._foreground, body)
        process.start(self.now_ns)
        while not process.finished:
            self._step(process)

    def _step(self, process: Process) -> None:
        target_ns = self._next_ns(process)
        reached_ns = self.now_ns
        if target_ns > self.now_ns:
            reached_ns = self.control.advance(target_ns)
        self._run_background(reached_ns)
        self._check_progress(reached_ns)
        self.now_ns = reached_ns
        self.control.dispatch(self.now_ns)
        due = self._foreground.pop_due(self.now_ns)
        if due is not None:
            self._count()
            due.run()
            self.control.dispatch(self.now_ns)

    def _run_background(self, until_ns: int) -> None:
        while (action := self._background.pop_due(until_ns)) is not None:
            self.now_ns = action.at_ns
            self._count()
            action.run()

    def _count(self) -> None:
        self._events += 1
        if self._events > self._most_events:
            text = f"the run has more than {self._most_events} events, {self.now_ns / 1e9:.0f} s are simulated"
            raise LimitReachedError(text, "mock-events")

    def _check_progress(self, reached_ns: int) -> None:
        """Raise RuntimeError where the clock is at standstill: a loop without a wait is a bug, and must not hang."""
        self._steps_at_once = 0 if reached_ns > self._last_ns else self._steps_at_once + 1
        self._last_ns = reached_ns
        if self._steps_at_once > _MAX_STEPS_AT_ONCE:
            raise RuntimeError(f"the clock does not advance at {reached_ns} ns")

    def _next_ns(self, process: Process) -> int:
        """Return the time up to which nothing can concern the control stack."""
        target_ns = self._foreground.next_ns()
        if target_ns is None:
            raise RuntimeError("a process waits and nothing is scheduled")
        background_ns = self._background.next_ns()
        if (process.awaits_background or self.heard_outside) and background_ns is not None:
            return min(target_ns, background_ns)
        return target_ns
