"""A crew of processes on this machine: fresh interpreters, which hear no signal of the terminal."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from functools import partial
from typing import Any

from cellc.compute.work import Crew, Hire, Sent, answer
from cellc.signals import deaf_children, start_deaf_tracker


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
    start_deaf_tracker()
    others = set(active_children())
    # Spawned on every platform: nothing of this process, its locks and threads above all, is copied into them.
    pool = ProcessPoolExecutor(size, get_context("spawn"), _told, (sent,))

    def ask(packet: Sequence[Any]) -> Future[Any]:
        return pool.submit(_answer, packet)

    ended = False
    try:
        with deaf_children():
            for _ in range(size):
                pool.submit(_answer, ())  # each starts a process, here where it is deaf
        yield Crew(ask, hands=2 * size)
        ended = True
    finally:
        for child in () if ended else set(active_children()) - others:
            child.terminate()
        pool.shutdown(cancel_futures=True)


_sent: Sent | None = None


def _told(sent: Sent) -> None:
    global _sent
    _sent = sent


def _answer(units: Sequence[Any]) -> list[Any]:
    assert _sent is not None  # a process is told before it is asked
    return answer(_sent, units)
