"""How a program of cellc ends when the system asks it to: one line, nothing half-written, 128 and the signal's number.

Shells report a process that a signal ended as 128 + N (POSIX XCU 2.8.2 asks for more than 128), so 130 is Ctrl-C and
143 SIGTERM: the code is the same whether the signal met Python before the first line of cellc or after it.

What a signal raises is no ``Exception``: everything that cleans up does so for it as for Ctrl-C. The first one stops
the program. Those that follow while it cleans up are not raised, and cannot cut that short; who insists gets out.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import TypeVar

# SIGHUP: the terminal was closed. SIGXCPU: limit of processor time, sent once a second from then on (Linux).
# Not SIGPIPE, which Python ignores: writing to a closed pipe raises BrokenPipeError instead.
_NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGXCPU")
STOPPING = tuple(getattr(signal, name) for name in _NAMES if hasattr(signal, name))

_Result = TypeVar("_Result")
CLOSED_PIPE = 128 + 13
"""Exit code where nothing reads the output any more: that of a process that SIGPIPE ends."""

_PATIENCE = 3  # signals that are not raised again while the program cleans up


class Stopped(BaseException):
    """A signal asked the program to end; ``number`` is the signal's."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


class _Watch:
    """What the handlers know: signals that arrived, and whether they are held back for now."""

    def __init__(self) -> None:
        self.received = 0
        self.raised = 0
        self.holding = False
        self.held: list[int] = []
        self.over = False

    def on_signal(self, number: int, frame: FrameType | None) -> None:
        """Raise the first signal; the ones after it only where there was no result."""
        if self.over:
            return
        if self.holding:
            self.held.append(number)
            return
        self.received += 1
        if self.received == 1 or self.received > _PATIENCE:
            self.raised = number
            raise Stopped(number)

    def on_alarm(self, number: int, frame: FrameType | None) -> None:
        """Raise what a callback swallowed."""
        if not self.over:
            raise Stopped(self.raised)


_watch = _Watch()


def run_program(run: Callable[[], int]) -> int:
    """Run a program, and return its exit code; what it printed last and was not taken is dropped when it is stopped."""
    _listen()
    try:
        try:
            return run()
        finally:
            # Ignore signals from here on: Python restores the default handlers at its exit, and a late signal would
            # kill a process that has completed its work.
            _watch.over = True
            _ignore()
    except Stopped as stop:
        _watch.over = True
        _ignore()
        drop_output()
        name = "" if stop.number == signal.SIGINT else f" by {signal.Signals(stop.number).name}"
        clear = "\r\x1b[K" if os.isatty(2) else ""
        with suppress(OSError):
            os.write(2, f"{clear}error: interrupted{name}; nothing was left half-written\n".encode())
        return 128 + stop.number


def drop_output() -> None:
    """Keep Python at its exit from waiting for a reader of the output, and from reporting a closed one."""
    with suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


@contextmanager
def held() -> Iterator[None]:
    """Raise a signal that comes during the block at its end: for code that catches everything, and would go on."""
    if _watch.holding or threading.current_thread() is not threading.main_thread():
        yield  # signals reach the main thread alone
        return
    # In a program of somebody else Ctrl-C alone is Python's, and is raised as such.
    foreign = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    _watch.holding = True
    if foreign:
        signal.signal(signal.SIGINT, _watch.on_signal)
    try:
        yield
    finally:
        if foreign:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        _watch.holding = False
        held, _watch.held = _watch.held, []
    if held and foreign:
        raise KeyboardInterrupt
    if held:
        _watch.on_signal(held[0], None)


class _OutOfTimeError(BaseException):
    """The work used all the processor time that it may use; no ``Exception``, like `Stopped`."""


def within(seconds: float, work: Callable[[], _Result]) -> _Result | None:
    """Return what some work gives, or None where this process used so much processor time before it ended.

    Children count by themselves, and 0 bounds nothing. Where there are no timers of processor time, as on Windows, and
    on any thread but the main one, the work is not bounded. Inside other work that is bounded, its time runs on.
    """
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        return work()
    outer_s = signal.getitimer(signal.ITIMER_PROF)[0]
    if not seconds or 0.0 < outer_s <= seconds:
        return work()
    end = _OutOfTimeError()

    def stop(number: int, frame: FrameType | None) -> None:
        raise end

    before, start_s = signal.signal(signal.SIGPROF, stop), time.process_time()
    try:
        # Again each second: code that catches everything would go on after the first.
        signal.setitimer(signal.ITIMER_PROF, seconds, 1.0)
        return work()
    except _OutOfTimeError as raised:
        if raised is not end:
            raise
        return None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
        if outer_s:
            left_s = outer_s - (time.process_time() - start_s)
            signal.setitimer(signal.ITIMER_PROF, max(left_s, 1e-3), 1.0)


@contextmanager
def signals_blocked_in_children() -> Iterator[None]:
    """Have processes that are started in the block hear none of these signals: who started them ends them.

    A terminal signals all processes of a program together. Children inherit the mask for good. SIGTERM still ends them:
    it is what Python's machinery of processes ends them by.
    """
    if sys.platform == "win32":
        yield
        return
    with held():
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGHUP})
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


def start_tracker_without_signals() -> None:
    """Start the process by which Python's multiprocessing follows what it has to clean up, to hear no signal at all.

    It ignores SIGINT and SIGTERM by itself, and is ended by any other that reaches a whole group of processes: a closed
    terminal's, or SIGXCPU of a batch system. Python then starts another, which complains of what it never heard of.
    It uses no processor time, and ends with its last client. Call it before
    ``signals_blocked_in_children``: Python opens SIGINT again in the process that starts it.
    """
    if sys.platform == "win32":  # Python has none there
        return
    from multiprocessing import resource_tracker  # takes longer to load than most commands last

    with signals_blocked_in_children():
        signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)
        resource_tracker.ensure_running()


def _listen() -> None:
    for number in STOPPING:
        # `nohup` and shells in the background start programs that are to ignore one.
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _watch.on_signal)
    if hasattr(signal, "setitimer"):
        _raise_lost_signals()


def _raise_lost_signals() -> None:
    """Have a signal raised again, by an alarm, where a callback of the interpreter swallowed it.

    Importing has such callbacks: one Ctrl-C in a hundred was lost while a check loaded.
    """
    others = sys.unraisablehook

    def again(swallowed: sys.UnraisableHookArgs) -> None:
        if issubclass(swallowed.exc_type, Stopped):
            raise_again()
        else:
            others(swallowed)

    signal.signal(signal.SIGALRM, _watch.on_alarm)
    sys.unraisablehook = again


def raise_again() -> None:
    """Raise a signal once more, in a moment: what runs now keeps it for itself, as a task of asyncio does."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, 0.01)


def _ignore() -> None:
    for number in (*STOPPING, *((signal.SIGALRM,) if hasattr(signal, "SIGALRM") else ())):
        signal.signal(number, signal.SIG_IGN)
