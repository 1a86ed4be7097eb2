"""A crew of processes on this machine: fresh interpreters, which hear no signal of the terminal.

They end with who hired them, however that ends: each would hold its output open, and go on for nobody.
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

from cellc.contract.compute.work import Crew, Hire, Sent, answer
from cellc.contract.signals import deaf_children, start_deaf_tracker

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

_ENDS_S = 5.0
"""How long a process may take to end before it is killed: one that is stopped hears nothing else."""
_PR_SET_PDEATHSIG = 1


def usable_cores() -> int:
    """Return the number of cores that the system lets this process use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


def processes(number: int) -> Hire:
    """Return who hires so many processes, or as many as there are units; leaving the crew early ends them at once."""
    return partial(_crew, number)


@contextmanager
def _crew(number: int, sent: Sent, units: int) -> Iterator[Crew]:
    # Python's machinery of processes takes longer to load than a small cell to check.
    from concurrent.futures.process import ProcessPoolExecutor
    from multiprocessing import active_children, get_context

    size = max(1, min(number, units))
    with _away():
        start_deaf_tracker()
    others = set(active_children())
    # Spawned on every platform: nothing of this process, its locks and threads above all, is copied into them.
    pool = ProcessPoolExecutor(size, get_context("spawn"), _told, (sent, Path.cwd()))

    def ask(packet: Sequence[Any]) -> Future[Any]:
        return pool.submit(_answer, packet)

    ended = False
    try:
        with deaf_children(), _away():
            for _ in range(size):
                pool.submit(_answer, ())  # each starts a process, here where it is deaf
        yield Crew(ask, hands=2 * size)
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


def _told(sent: Sent, folder: Path) -> None:
    global _sent
    _sent = sent
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

    if sys.platform == "linux":  # at once, in the middle of what holds the interpreter too; prctl(2)
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    Thread(target=watch, name="parent", daemon=True).start()


def _answer(units: Sequence[Any]) -> list[Any]:
    assert _sent is not None  # a process is told before it is asked
    return answer(_sent, units)
