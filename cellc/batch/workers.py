"""Several processes that compute answers; nothing of them is seen in what is answered."""

from __future__ import annotations

import signal
from collections.abc import Callable, Generator, Sequence
from concurrent.futures.process import BrokenProcessPool, ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from typing import TypeVar

from cellc.batch.answer import Answer
from cellc.batch.compute import Kind, compute
from cellc.disk import Record

_T = TypeVar("_T")


def in_workers(kind: Kind, files: Sequence[str], number: int) -> Generator[tuple[Answer, Record], None, None]:
    """Yield answers in the order of the specs, however many processes compute them; closing it ends them all.

    Raises:
        KeyboardInterrupt: what had not begun was dropped, and no process is left.
    """
    # Spawned on every platform: nothing of this process, its locks and threads above all, is copied into them.
    pool = ProcessPoolExecutor(number, mp_context=get_context("spawn"))
    done = 0
    try:
        for answer in _without_interrupts(lambda: pool.map(partial(compute, kind), files)):
            done += 1
            yield answer
    except BrokenProcessPool:  # the system ended one, for want of memory say
        yield from (compute(kind, file) for file in files[done:])
    finally:
        pool.shutdown(cancel_futures=True)


def _without_interrupts(start: Callable[[], _T]) -> _T:
    """Start processes that never see Ctrl-C, which a terminal sends to all: this process ends them in good order."""
    if not hasattr(signal, "pthread_sigmask"):
        return start()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        return start()  # a process begins with the mask of who started it
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
