"""Fan-out: one shared job, many units, a stream of results from local processes or a Dask cluster.

An answer is that of its unit alone, so that any worker gives the same, however often. A worker that dies
therefore costs time and nothing else: what it had in hand is done again by others. A unit that was in hand at two
deaths is done alone, so that the third one shows which unit it is that no worker survives.
"""

from __future__ import annotations

import gc
import hashlib
import pickle
import threading
from collections import Counter, deque
from collections.abc import Callable, Generator, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait
from contextlib import AbstractContextManager
from typing import Any, Generic, TypeVar

from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass

Shared = TypeVar("Shared")
Unit = TypeVar("Unit")
Answer = TypeVar("Answer")

MOST_DEATHS = 3
"""Workers that may end by themselves with one unit in hand; a machine that is short of memory recovers, a bug stays."""


class ComputeError(CellcError):
    """Work could not be done; the text is one line."""


@dataclass(frozen=True, slots=True)
class Work(Generic[Shared, Unit, Answer]):
    """What is done with each unit.

    Attributes:
        begin: a function of a module; it makes of what all units need what answers one. It runs once in each process.
        shared: what all units need.
        name: what a unit is called in messages.
    """

    begin: Callable[[Shared], Callable[[Unit], Answer]]
    shared: Shared
    name: Callable[[Unit], str] = str


@dataclass(frozen=True, slots=True)
class Sent:
    """Work as it is sent: its bytes, known by their content."""

    digest: str
    content: bytes

    @classmethod
    def of(cls, work: Work[Any, Any, Any]) -> Sent:
        """Return what is sent of some work."""
        content = pickle.dumps((work.begin, work.shared), protocol=pickle.HIGHEST_PROTOCOL)
        return cls(hashlib.sha256(content).hexdigest(), content)


@dataclass(frozen=True, slots=True)
class Executor:
    """Workers that have received the shared job.

    Attributes:
        submit: takes some units, and returns the future of their answers.
        max_in_flight: units, or packets of them, that are in flight together.
        packet: units that are sent together where there are so many.
        check_period_s: how often ``check_health`` is called while nothing ends; None for never.
        check_health: raises ComputeError where the workers are out of reach.
    """

    submit: Callable[[Sequence[Any]], Future[Any]]
    max_in_flight: int
    packet: int = 1
    check_period_s: float | None = None
    check_health: Callable[[], None] = lambda: None


ExecutorFactory = Callable[[Sent, int], AbstractContextManager[Executor]]
"""Returns an executor for a job of so many units; leaving it ends or lets go of the workers."""


def stream(
    work: Work[Shared, Unit, Answer], units: Sequence[Unit], factory: ExecutorFactory
) -> Generator[tuple[int, Answer], None, None]:
    """Yield the number and answer of every unit once, in any order; closing it lets go of the workers.

    Raises:
        ComputeError: no worker can do a unit, or none is within reach. What a unit raises is raised too.
    """
    sent, deaths, owed = Sent.of(work), Counter[int](), _Owed(len(units))
    while owed:
        alone = [number for number in owed.returned if deaths[number] == MOST_DEATHS - 1]
        batches = [_Owed.only(number) for number in alone] or [owed]
        for batch in batches:
            if alone:
                owed.returned.remove(batch.returned[0])
            with factory(sent, len(batch)) as executor:
                lost: tuple[int, ...] = yield from _deal(units, batch, executor)
            deaths.update(lost)
            owed.returned.extendleft(reversed(lost))
            failed = next((number for number in lost if deaths[number] == MOST_DEATHS), None)
            if failed is not None:
                raise ComputeError(
                    f"the process of `{work.name(units[failed])}` ended by itself, {MOST_DEATHS} times in a row"
                )


class _Owed:
    """Units to do: those that were lost first, and then the rest, of which only the next number is kept."""

    def __init__(self, number: int) -> None:
        self.returned = deque[int]()
        self._rest = range(number)

    @classmethod
    def only(cls, number: int) -> _Owed:
        owed = cls(0)
        owed.returned.append(number)
        return owed

    def __len__(self) -> int:
        return len(self.returned) + len(self._rest)

    def take(self, most: int) -> tuple[int, ...]:
        """Return the next units, at most so many."""
        lost = tuple(self.returned.popleft() for _ in range(min(most, len(self.returned))))
        fresh = self._rest[: most - len(lost)]
        self._rest = self._rest[len(fresh) :]
        return (*lost, *fresh)


def _deal(
    units: Sequence[Unit], owed: _Owed, executor: Executor
) -> Generator[tuple[int, Answer], None, tuple[int, ...]]:
    """Yield answers until all are there or the workers are lost; return what they had in hand then."""
    busy: dict[Future[Any], tuple[int, ...]] = {}
    try:
        while busy or owed:
            while owed and len(busy) < executor.max_in_flight:
                packet = owed.take(executor.packet)
                busy[executor.submit([units[number] for number in packet])] = packet
            ended, _ = wait(busy, executor.check_period_s, FIRST_COMPLETED)
            executor.check_health()
            for future in ended:
                answers = future.result()
                yield from zip(busy.pop(future), answers, strict=True)
    except BrokenExecutor:
        return tuple(sorted(number for packet in busy.values() for number in packet))
    return ()


def in_order(answers: Iterable[tuple[int, Answer]]) -> Generator[Answer, None, None]:
    """Yield answers by their numbers."""
    early: dict[int, Answer] = {}
    following = 0
    for number, answer in answers:
        early[number] = answer
        while following in early:
            yield early.pop(following)
            following += 1


_RARE = 20_000
"""Objects that come before the youngest generation is looked through; usual are 700 (docs.python.org, ``gc``)."""


def settle() -> None:
    """Spare the garbage collector what was loaded for good: it would look through it again for every few units.

    A tenth of the processor time of a run of the mock was spent there.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(_RARE, *gc.get_threshold()[1:])


_known: dict[str, Callable[[Any], Any]] = {}
_turn = threading.Lock()


def answer(sent: Sent, units: Sequence[Unit]) -> list[Any]:
    """Answer some units in a worker; it begins work that it does not know yet, and forgets other work."""
    with _turn:  # a worker of Dask has threads, and what a process executes has tables of the process
        if sent.digest not in _known:
            begin, shared = pickle.loads(sent.content)
            _known.clear()
            gc.unfreeze()
            _known[sent.digest] = begin(shared)
            settle()
        return [_known[sent.digest](unit) for unit in units]
