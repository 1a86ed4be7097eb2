"""Joints of one device behind springs, cycle by cycle: gravity moves them from their commands, damping delays them.

Without mass and friction: `damping * velocity = stiffness * (command - position) - weight`, where damping brakes the
motion; where it brakes the error alone, the same with the velocity of the error. Weights are looked up every 10 ms of
motion, on a grid of cycles that does not depend on how many are computed together, and never while nothing moves.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cellc.contract.control_law import ControlLaw
from cellc.contract.frozen import dataclass
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
    """Cycles that were computed.

    Attributes:
        wanted: commands by cycle and joint; the first row is the last command before.
        taken: positions by joint and cycle.
        looks: what held up to a cycle, with the number of that cycle.
    """

    wanted: Array
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
        wanted = np.empty((len(commanded) + 1, len(shares)))
        wanted[:] = self._commanded
        wanted[1:, own] = commanded[:, columns]
        self._computed = self._compute(wanted, shares, cycle, period_s)
        for number, column in zip(own, columns, strict=True):
            commanded[:, column] = self._computed.taken[number]

    def commit(self, cycles: int) -> None:
        """Adopt the first cycles of what was computed last."""
        done = self._computed
        if done is None:
            return
        self._look = next(look for end, look in done.looks if end >= cycles)
        self._positions = [taken[cycles - 1] for taken in done.taken]
        self._commanded = done.wanted[cycles].tolist()
        self._steps = (done.wanted[cycles] - done.wanted[cycles - 1]).tolist()

    def _matched(self, indices: tuple[int, ...]) -> tuple[list[int], list[int]]:
        """Return which joints of the law are commanded, and the column of each."""
        if indices not in self._known:
            places = {index: column for column, index in enumerate(indices)}
            own = [number for number, index in enumerate(self._joints.tolist()) if index in places]
            self._known[indices] = own, [places[index] for index in self._joints[own].tolist()]
        return self._known[indices]

    def _compute(self, wanted: Array, shares: _Values, cycle: int, period_s: float) -> _Computed:
        """Compute where the joints go; one whose share of the way in a cycle is zero stays where it is.

        Args:
            wanted: commands by cycle and joint; the first row is the last command before.
        """
        grid, cycles = max(1, round(_LOOK_S / period_s)), len(wanted) - 1
        changes = np.flatnonzero((wanted[1:] != wanted[:-1]).any(axis=1)).tolist()
        along = self._along(wanted)
        done = _Computed(wanted, [[] for _ in shares], [])
        look, positions, row = self._look, self._positions, 0
        while row < cycles:
            offset = (cycle + row) % grid
            if look is None or not look.at or offset == 0:
                passed_s = 0.0 if offset else grid * period_s
                look, positions = self._looked(look, positions, wanted[row].tolist(), shares, passed_s)
            change = bisect_left(changes, row)
            end = changes[change] if change < len(changes) else cycles
            if look.settled and end > row:
                _stay(done.taken, positions, end - row)
            else:
                look = replace(look, settled=False) if look.settled else look
                end = min(cycles, row + grid - offset)
                goals = wanted[row + 1 : end + 1] - look.droop
                _move(done.taken, positions, shares, goals, along[row:end])
                positions = [column[-1] for column in done.taken]
            done.looks.append((end, look))
            row = end
        return done

    def _along(self, wanted: Array) -> Array:
        """Return how far the velocity of the command takes each joint along in each cycle, rad or m.

        It does where damping brakes the error alone. A command that jumps once, as that of a hold does, has no
        velocity: of two steps in a row the smaller counts.
        """
        steps = np.diff(wanted, axis=0)
        if self._lags:
            return np.zeros_like(steps)
        before = np.vstack((self._steps, steps[:-1]))
        smaller = np.where(np.abs(before) < np.abs(steps), before, steps)
        return np.where(steps * before > 0.0, smaller, 0.0)

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


def _near(ones: _Values, others: _Values) -> bool:
    return all(abs(one - other) <= _STILL for one, other in zip(ones, others, strict=True))


def _stay(taken: list[_Values], positions: _Values, cycles: int) -> None:
    for column, at in zip(taken, positions, strict=True):
        column.extend([at] * cycles)


def _move(taken: list[_Values], positions: _Values, shares: _Values, goals: Array, along: Array) -> None:
    """Move the joints through some cycles: along with their commands, and by their share of the way to their goals."""
    rows = zip(taken, positions, shares, goals.T.tolist(), along.T.tolist(), strict=True)
    for column, at, share, targets, steps in rows:
        for target, step in zip(targets, steps, strict=True):
            at += step
            at += share * (target - at)
            column.append(at)
