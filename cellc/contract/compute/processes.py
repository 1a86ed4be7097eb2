"""Executor of processes on this machine: fresh interpreters, which receive no signal of the terminal.

They end with their parent, however that ends: each would hold its output open, and run on without a caller.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from threading import Thread, Timer
from typing import TYPE_CHECKING, Any

from cellc.contract.compute.work import Executor, ExecutorFactory, Sent, answer
from cellc.contract.signals import signals_blocked_in_children, start_tracker_without_signals

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess
    from multiprocessing.queues import SimpleQueue

_ENDS_S = 5.0
"""How long a process may take to end before it is killed: one that is stopped hears nothing else."""
_PR_SET_PDEATHSIG = 1


def usable_cores() -> int:
    """Return the number of cores that the system lets this process use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


def processes(number: int) -> ExecutorFactory:
    """Return a factory for so many processes, at most one a unit; leaving the executor early ends them."""
    return partial(_executor, number)


@contextmanager
def _executor(number: int, sent: Sent, units: int) -> Iterator[Executor]:
    # Python's machinery of processes takes longer to load than a small cell to check.
    from concurrent.futures.process import ProcessPoolExecutor
    from multiprocessing import active_children, get_context

    size = max(1, min(number, units))
    with _away():
        start_tracker_without_signals()
    others = set(active_children())
    # Spawned on every platform: nothing of this process, its locks and threads above all, is copied into them.
    context = get_context("spawn")
    numbers = context.SimpleQueue()
    for each in range(size):
        numbers.put(each)
    pool = ProcessPoolExecutor(size, context, _receive, (sent, Path.cwd(), numbers))

    def submit(packet: Sequence[Any]) -> Future[Any]:
        return pool.submit(_answer, packet)

    ended = False
    try:
        with signals_blocked_in_children(), _away():
            for _ in range(size):
                pool.submit(_answer, ())  # each starts a process, here where it receives no signals
        yield Executor(submit, max_in_flight=2 * size)
        ended = True
    finally:
        mine = set(active_children()) - others
        for child in () if ended else mine:
            child.terminate()
        patience = Timer(_ENDS_S, _kill, (mine,))
        patience.daemon = True
        patience.start()
        pool.shutdown(cancel_futures=True)  # where Ctrl-C comes meanwhile, what is left is killed all the same
        patience.cancel()


@contextmanager
def _away() -> Iterator[None]:
    """Start processes away from the current folder: Python 3.10 imports from it first, and knows no PYTHONSAFEPATH."""
    if sys.version_info >= (3, 11):
        yield
        return
    here = Path.cwd()
    os.chdir(sys.prefix)
    try:
        yield
    finally:
        os.chdir(here)


def _kill(children: Iterable[BaseProcess]) -> None:
    for child in children:
        child.kill()


_sent: Sent | None = None
_number = 0


def process_number() -> int:
    """Return the number of this process among those of its executor, from 0; 0 in a process that no executor has."""
    return _number


def _receive(sent: Sent, folder: Path, numbers: SimpleQueue[int]) -> None:
    global _sent, _number
    _sent, _number = sent, numbers.get()
    os.chdir(folder)
    _end_with_parent()


def _end_with_parent() -> None:
    """End this process as soon as its parent is gone, killed too."""
    from multiprocessing import parent_process
    from multiprocessing.connection import wait

    parent = parent_process()
    assert parent is not None  # this one was started by another
    gone = [parent.sentinel]

    def watch() -> None:
        wait(gone)
        os._exit(1)

    if sys.platform == "linux":  # immediately, in the middle of what holds the interpreter too; prctl(2)
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    Thread(target=watch, name="parent", daemon=True).start()


def _answer(units: Sequence[Any]) -> list[Any]:
    assert _sent is not None  # a process receives the job before its first unit
    return answer(_sent, units)
