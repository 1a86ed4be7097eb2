"""How the runs of a sweep ended, in columns: of ten million runs, none may take a kilobyte."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import isnan, nan
from typing import overload

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass

Figures = NDArray[np.float64]
Flags = NDArray[np.bool_]
_Rows = NDArray[np.int32]
_AT_FIRST = 1024
_DENSE = 1 << 26
"""Numbers below it are found by their place in an array; larger ones, which few runs have, in a table."""
_ROOM = ("distance_m", "singular_value", "joint_room", "clearance_m", "transform_age_s")


@dataclass(frozen=True, slots=True)
class GoalRoom:
    """The worst of all arrivals at a goal in one run; see ``Arrival``."""

    distance_m: float
    singular_value: float
    joint_room: float | None
    clearance_m: float | None
    transform_age_s: float | None


@dataclass(frozen=True, slots=True)
class SweepRun:
    """How one run ended.

    Attributes:
        number: from 0; with the seed it gives all draws.
        outcome: of the rehearsal, or ``missed GOAL`` where that ended as it should and the tip was too far off.
        goals: where the tip arrived.
        joint_state_age_s: of the oldest joint state that a motion was planned from; None without one.
        digest: over attempts and arrivals, so that a replay can be compared bit for bit.
    """

    number: int
    outcome: str
    passed: bool
    goals: Mapping[str, GoalRoom]
    joint_state_age_s: float | None
    digest: str


@dataclass(frozen=True, slots=True)
class _Ending:
    """What many runs have in common: how they ended, and at which goals they arrived, in their order."""

    outcome: str
    passed: bool
    goals: tuple[str, ...]


class RunStore(Mapping[int, SweepRun]):
    """Runs by their number, each equal to the last bit to what was added.

    A run takes 28 bytes, 4 for each number up to the largest, and 40 for each goal that any run arrived at. None is
    NaN there, which no figure of a run is; what runs have in common is there once.
    """

    def __init__(self) -> None:
        """Begin without runs."""
        self._length = 0
        self._endings: dict[_Ending, int] = {}
        self._ending_of: list[_Ending] = []
        self._other_digests: dict[int, str] = {}  # a run that broke the mock has the name of the error
        self._numbers = np.zeros(_AT_FIRST, np.int64)
        self._ending = np.zeros(_AT_FIRST, np.uint32)
        self._digest = np.zeros(_AT_FIRST, np.uint64)
        self._age_s = np.zeros(_AT_FIRST)
        self._rooms: dict[str, Figures] = {}
        self._row_after = np.zeros(_AT_FIRST, np.int32)
        self._row_beyond: dict[int, int] = {}

    def add(self, run: SweepRun) -> None:
        """Add a run that is not there yet."""
        assert run.number not in self, run.number
        row = self._length
        if row == len(self._numbers):
            self._grow()
        self._length += 1
        self._numbers[row] = run.number
        self._ending[row] = self._common(_Ending(run.outcome, run.passed, tuple(run.goals)))
        self._age_s[row] = nan if run.joint_state_age_s is None else run.joint_state_age_s
        for goal, room in run.goals.items():
            figures = (getattr(room, name) for name in _ROOM)
            self._rooms[goal][row] = [nan if figure is None else figure for figure in figures]
        if (digest := _sixty_four_bits(run.digest)) is None:
            self._other_digests[row] = run.digest
        else:
            self._digest[row] = digest
        self._place(run.number, row)

    def _common(self, ending: _Ending) -> int:
        if ending not in self._endings:
            self._endings[ending] = len(self._ending_of)
            self._ending_of.append(ending)
            for goal in ending.goals:
                self._rooms.setdefault(goal, np.full((len(self._numbers), len(_ROOM)), nan))
        return self._endings[ending]

    def _grow(self) -> None:
        rows = _more(self._length)
        for column in (self._numbers, self._ending, self._digest, self._age_s):
            column.resize(rows, refcheck=False)  # in place: no second copy of what is there
        for room in self._rooms.values():
            room.resize((rows, len(_ROOM)), refcheck=False)
            room[self._length :] = nan

    def _place(self, number: int, row: int) -> None:
        if number >= _DENSE:
            self._row_beyond[number] = row
            return
        if number >= len(self._row_after):
            self._row_after.resize(max(_more(len(self._row_after)), number + 1), refcheck=False)
        self._row_after[number] = row + 1  # 0 for none

    def _row(self, number: int) -> int | None:
        if 0 <= number < len(self._row_after):
            after = int(self._row_after[number])
            return after - 1 if after else None
        return self._row_beyond.get(number)

    def __contains__(self, number: object) -> bool:
        return isinstance(number, int) and self._row(number) is not None

    def __getitem__(self, number: int) -> SweepRun:
        row = self._row(number)
        if row is None:
            raise KeyError(number)
        return self.at(row)

    def __iter__(self) -> Iterator[int]:
        return map(int, self._numbers[: self._length])

    def __len__(self) -> int:
        return self._length

    def at(self, row: int) -> SweepRun:
        """Return a run by its place in the order in which they were added."""
        ending = self._ending_of[self._ending[row]]
        rooms = {goal: _room(self._rooms[goal][row]) for goal in ending.goals}
        digest = self._other_digests.get(row, f"{int(self._digest[row]):016x}")
        return SweepRun(
            int(self._numbers[row]), ending.outcome, ending.passed, rooms, _stated(float(self._age_s[row])), digest
        )

    @property
    def bytes_each(self) -> float:
        """What a run takes of memory in the columns."""
        columns = (self._numbers, self._ending, self._digest, self._age_s, self._row_after)
        rooms = sum(room.nbytes for room in self._rooms.values())
        return (rooms + sum(column.nbytes for column in columns)) / self._length

    def missing(self, most: int) -> Sequence[int]:
        """Return the numbers below ``most`` of which there is no run; they take no memory where none is there."""
        if not self._length:
            return range(most)
        there = np.zeros(most, np.bool_)
        known = self._row_after[:most]
        there[: len(known)] = known > 0
        return array("q", np.flatnonzero(~there).astype(np.int64).tobytes())

    def first(self, number: int) -> SweepRuns:
        """Return the runs of the first numbers, all of which are there."""
        return SweepRuns(self, self._row_after[:number] - 1)

    def of(self, numbers: Iterable[int]) -> SweepRuns:
        """Return the runs of some numbers, which are there."""
        rows = [row for row in map(self._row, numbers) if row is not None]
        return SweepRuns(self, np.array(rows, np.int32))

    def endings(self, rows: _Rows) -> list[tuple[_Ending, Flags]]:
        """Return how runs ended, each with those that did."""
        ending = self._ending[rows]
        return [(each, ending == place) for place, each in enumerate(self._ending_of)]

    def numbers(self, rows: _Rows) -> NDArray[np.int64]:
        """Return the numbers of runs."""
        return self._numbers[rows]

    def ages_s(self, rows: _Rows) -> Figures:
        """Return the ages of joint states, NaN where there was none."""
        return self._age_s[rows]

    def room(self, goal: str, figure: str, rows: _Rows) -> Figures:
        """Return a figure of a goal, NaN where a run did not arrive there or has none."""
        figures: Figures = self._rooms[goal][rows, _ROOM.index(figure)]
        return figures


class SweepRuns(Sequence[SweepRun]):
    """Some runs of a store in an order, and their columns."""

    def __init__(self, store: RunStore, rows: _Rows) -> None:
        """Take the runs of these rows."""
        self._store = store
        self._rows = rows

    @classmethod
    def listed(cls, runs: Iterable[SweepRun]) -> SweepRuns:
        """Return runs, each of another number, in their order."""
        store = RunStore()
        for run in runs:
            store.add(run)
        return store.of(store)

    @overload
    def __getitem__(self, place: int) -> SweepRun: ...
    @overload
    def __getitem__(self, place: slice) -> SweepRuns: ...
    def __getitem__(self, place: int | slice) -> SweepRun | SweepRuns:
        if isinstance(place, slice):
            return SweepRuns(self._store, self._rows[place])
        return self._store.at(int(self._rows[place]))

    def __len__(self) -> int:
        return len(self._rows)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SweepRuns):
            return NotImplemented
        return len(self) == len(other) and all(one == another for one, another in zip(self, other, strict=True))

    def __hash__(self) -> int:
        return hash(tuple(self.numbers.tolist()))

    @property
    def numbers(self) -> NDArray[np.int64]:
        """The number of each run."""
        return self._store.numbers(self._rows)

    @property
    def passed(self) -> Flags:
        """Whether each run passed."""
        flags = np.zeros(len(self), np.bool_)
        for ending, which in self._endings():
            flags |= which & ending.passed
        return flags

    @property
    def failed(self) -> SweepRuns:
        """The runs that did not pass."""
        return SweepRuns(self._store, self._rows[~self.passed])

    @property
    def goals(self) -> list[str]:
        """The goals that any of these runs arrived at, by name."""
        return sorted({goal for ending, which in self._endings() if which.any() for goal in ending.goals})

    @property
    def joint_state_ages_s(self) -> Figures:
        """The ages of joint states that runs have."""
        return _there(self._store.ages_s(self._rows))

    def outcomes(self) -> Counter[str]:
        """Count how runs ended, in the order of the first that ended so."""
        firsts = sorted((int(which.argmax()), ending, which) for ending, which in self._endings() if which.any())
        counted = Counter[str]()
        for _, ending, which in firsts:
            counted[ending.outcome] += int(which.sum())
        return counted

    def room(self, goal: str, figure: str) -> Figures:
        """Return a figure of ``GoalRoom`` of the runs that have it."""
        return _there(self._store.room(goal, figure, self._rows))

    def _endings(self) -> list[tuple[_Ending, Flags]]:
        return self._store.endings(self._rows)


def _more(rows: int) -> int:
    """Return how many rows follow: an eighth more, as what is added is memory that nothing may fill."""
    return rows + max(_AT_FIRST, rows // 8)


def _there(figures: Figures) -> Figures:
    return figures[~np.isnan(figures)]


def _room(figures: Figures) -> GoalRoom:
    distance_m, singular_value, *others = map(float, figures)
    return GoalRoom(distance_m, singular_value, *map(_stated, others))


def _stated(figure: float) -> float | None:
    return None if isnan(figure) else figure


def _sixty_four_bits(digest: str) -> int | None:
    """Return what 16 hexadecimal digits say; None of another text."""
    try:
        bits = int(digest, 16)
    except ValueError:
        return None
    return bits if f"{bits:016x}" == digest else None
