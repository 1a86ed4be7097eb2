"""Joints of one device behind springs, cycle by cycle: gravity moves them from their commands, damping delays them.

Without mass and friction: `damping * velocity = stiffness * (command - position) - weight`, where damping brakes the
motion; where it brakes the error alone, the same with the velocity of the error. Weights are looked up every 10 ms of
motion, on a grid of cycles that does not depend on how many are computed together, and never while nothing moves.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cellc.contract.control_law import ControlLaw
from cellc.mock.control.interfaces import Array
from cellc.robot.planning import Springs

_LOOK_S = 0.01
"""From one look at the weights to the next: 10 mrad at 1 rad/s, by which few arms change what they hold by 2 %."""
_STILL = 1e-10
"""Rad or m: a joint that is nearer to where it comes to rest is there."""
_FARTHEST = 1.0
"""Rad or m: no weight stretches a spring farther."""

_Values = list[float]
"""Of each joint, in the order of the law; plain numbers, for few of them are computed at a time."""


@dataclass(frozen=True, slots=True)
class _Look:
    """What was looked up last, and holds until it is looked up again.

    Attributes:
        at: where the joints were.
        weights: what they must give there, Nm or N.
        integral: what their integrals give of it.
        droop: how far from their commands they come to rest, rad or m.
        settled: they are at rest until a command changes.
    """

    at: _Values
    weights: _Values
    integral: _Values
    droop: _Values
    settled: bool


@dataclass(frozen=True, slots=True)
class _Computed:
    """Cycles that were computed; rows of ``wanted`` begin with the last command before.

    Attributes:
        wanted, taken: by joint and cycle.
        looks: what held up to a cycle, with the number of that cycle.
    """

    wanted: list[_Values]
    taken: list[_Values]
    looks: list[tuple[int, _Look]]


class SpringJoints:
    """Follows the commands of a component's joints by their law.

    Args:
        law: of the device.
        springs: bound to its robot and its load.
        names: joints of the component, in its order.
        positions: of the same joints now, rad or m.
    """

    def __init__(self, law: ControlLaw, springs: Springs, names: Sequence[str], positions: Array) -> None:
        self._springs = springs
        self._joints: NDArray[np.intp] = np.array([list(names).index(joint) for joint in law.joints], dtype=np.intp)
        self._laws = tuple(law.joints.values())
        self._lags = law.lags
        self._integrates = any(joint.integral for joint in self._laws)
        self._known: dict[tuple[int, ...], tuple[list[int], list[int]]] = {}
        self._look: _Look | None = None
        self._computed: _Computed | None = None
        self.rest(positions)

    @property
    def settled(self) -> bool:
        """Whether nothing moves until a command does."""
        return self._look is not None and self._look.settled

    def load(self, springs: Springs) -> None:
        """Let the joints hold another load from now on."""
        self._springs = springs
        self._look = None if self._look is None else replace(self._look, at=[], settled=False)

    def rest(self, positions: Array) -> None:
        """Let the joints begin again from where they are, as after a time in which no command reached them."""
        self._positions: _Values = positions[self._joints].tolist()
        self._commanded, self._steps = self._positions, [0.0] * len(self._laws)
        self._look = self._computed = None

    def clear(self) -> None:
        """Forget what was computed and not adopted."""
        self._computed = None

    def follow(self, indices: NDArray[np.intp], commanded: Array, cycle: int, period_s: float) -> None:
        """Replace commanded positions of successive cycles by those that the joints take.

        Args:
            indices: joints of the component in the columns of ``commanded``; others stay where they are.
            commanded: rad or m, shape (cycles, indices); written in place.
            cycle: number of the first cycle.
            period_s: time between two cycles.
        """
        own, columns = self._matched(tuple(indices.tolist()))
        if not own:
            return
        shares = [0.0] * len(self._laws)
        for number in own:
            shares[number] = period_s / (self._laws[number].lag_s + period_s)
        rows = (
            np.tile(self._commanded, (len(commanded), 1))
            if len(own) < len(shares)
            else np.empty((len(commanded), len(own)))
        )
        rows[:, own] = commanded[:, columns]
        self._computed = self._compute([self._commanded, *rows.tolist()], shares, cycle, period_s)
        for number, column in zip(own, columns, strict=True):
            commanded[:, column] = self._computed.taken[number]

    def commit(self, cycles: int) -> None:
        """Adopt the first cycles of what was computed last."""
        done = self._computed
        if done is None:
            return
        self._look = next(look for end, look in done.looks if end >= cycles)
        self._positions = [taken[cycles - 1] for taken in done.taken]
        self._commanded = [wanted[cycles] for wanted in done.wanted]
        self._steps = [wanted[cycles] - wanted[cycles - 1] for wanted in done.wanted]

    def _matched(self, indices: tuple[int, ...]) -> tuple[list[int], list[int]]:
        """Return which joints of the law are commanded, and the column of each."""
        if indices not in self._known:
            places = {index: column for column, index in enumerate(indices)}
            own = [number for number, index in enumerate(self._joints.tolist()) if index in places]
            self._known[indices] = own, [places[index] for index in self._joints[own].tolist()]
        return self._known[indices]

    def _compute(self, rows: list[_Values], shares: _Values, cycle: int, period_s: float) -> _Computed:
        """Compute where the joints go; one whose share of the way in a cycle is zero stays where it is.

        Args:
            rows: commands, the last one before at first.
        """
        grid, cycles = max(1, round(_LOOK_S / period_s)), len(rows) - 1
        changes = [row for row in range(cycles) if rows[row] != rows[row + 1]]
        done = _Computed([list(column) for column in zip(*rows, strict=True)], [[] for _ in shares], [])
        look, positions, row = self._look, self._positions, 0
        while row < cycles:
            offset = (cycle + row) % grid
            if look is None or not look.at or offset == 0:
                passed_s = 0.0 if offset else grid * period_s
                look, positions = self._looked(look, positions, rows[row], shares, passed_s)
            change = bisect_left(changes, row)
            end = changes[change] if change < len(changes) else cycles
            if look.settled and end > row:
                _stay(done.taken, positions, end - row)
            else:
                look = replace(look, settled=False) if look.settled else look
                end = min(cycles, row + grid - offset)
                positions = list(self._moved(done, look.droop, positions, shares, row, end))
            done.looks.append((end, look))
            row = end
        return done

    def _looked(
        self, last: _Look | None, positions: _Values, commanded: _Values, shares: _Values, passed_s: float
    ) -> tuple[_Look, _Values]:
        """Look up what the joints must give where they are; those that have come to rest are put there exactly.

        Args:
            passed_s: since the integrals were computed last.
        """
        integral = [0.0] * len(positions) if last is None else last.integral
        if self._integrates:
            integral = [
                more if law.integral_most is None else min(max(more, -law.integral_most), law.integral_most)
                for law, given, goal, here in zip(self._laws, integral, commanded, positions, strict=True)
                for more in (given + law.integral * (goal - here) * passed_s,)
            ]
        if last is not None and last.at and _near(positions, last.at):
            at, weights = last.at, last.weights
        else:
            at, weights = positions, self._springs.efforts(np.array(positions)).tolist()
        droop = [
            min(max((weight - given) / law.stiffness, -_FARTHEST), _FARTHEST)
            for law, weight, given in zip(self._laws, weights, integral, strict=True)
        ]
        rest = [
            goal - away if share else here
            for here, goal, away, share in zip(positions, commanded, droop, shares, strict=True)
        ]
        if self._integrates or not _near(rest, positions):
            return _Look(at, weights, integral, droop, settled=False), positions
        return _Look(rest, weights, integral, droop, settled=True), rest

    def _moved(
        self, done: _Computed, droop: _Values, positions: _Values, shares: _Values, row: int, end: int
    ) -> Iterator[float]:
        """Move the joints through some cycles, and yield where each is then.

        Where damping brakes the error alone, the velocity of the command takes them along. A command that jumps once,
        as that of a hold does, has no velocity: of two steps in a row the smaller counts.
        """
        for joint, (at, share, away) in enumerate(zip(positions, shares, droop, strict=True)):
            wanted, column = done.wanted[joint], done.taken[joint]
            before = wanted[row] - wanted[row - 1] if row else self._steps[joint]
            for last, goal in pairwise(wanted[row : end + 1]):
                if not self._lags:
                    step = goal - last
                    if step * before > 0.0:
                        at += before if abs(before) < abs(step) else step
                    before = step
                at += share * (goal - away - at)
                column.append(at)
            yield at


def _near(ones: _Values, others: _Values) -> bool:
    return all(abs(one - other) <= _STILL for one, other in zip(ones, others, strict=True))


def _stay(taken: list[_Values], positions: _Values, cycles: int) -> None:
    for column, at in zip(taken, positions, strict=True):
        column.extend([at] * cycles)
