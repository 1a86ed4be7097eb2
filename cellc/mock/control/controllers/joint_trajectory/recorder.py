"""Records the state of the controller, thinned to a told rate, for plots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellc.mock.control.block import Block
from cellc.mock.control.controllers.joint_trajectory.motion import Samples
from cellc.mock.control.interfaces import Array, Columns, Times


@dataclass(frozen=True, slots=True)
class Recording:
    """Successive states of a trajectory controller.

    Attributes:
        stamps_ns: times of the updates, shape (m,).
        joints: names of the joints.
        desired: desired positions, shape (m, joints).
        desired_velocity: desired velocities.
        actual: measured positions.
        command: commanded values of the first command interface, after limits.
    """

    stamps_ns: Times
    joints: tuple[str, ...]
    desired: Array
    desired_velocity: Array
    actual: Array
    command: Array


class Recorder:
    """Collects the updates of a controller.

    Args:
        joints: names of the joints.
        period_ns: time between two records at least.
    """

    def __init__(self, joints: tuple[str, ...], period_ns: int) -> None:
        self._joints = joints
        self._period_ns = period_ns
        self._next_ns = 0
        self._stamps: list[Times] = []
        self._values: list[tuple[Array, Array, Array, Array]] = []

    def _due(self, times_ns: Times) -> Columns:
        """Rows that are recorded: in each record period the first update."""
        if times_ns[-1] < self._next_ns:
            return np.empty(0, dtype=np.intp)
        slots = times_ns // self._period_ns
        first = np.empty(len(slots), dtype=bool)
        first[0] = times_ns[0] >= self._next_ns
        np.not_equal(slots[1:], slots[:-1], out=first[1:])
        self._next_ns = int(slots[-1] + 1) * self._period_ns
        return np.flatnonzero(first)

    def add_update(self, time_ns: int, samples: Samples, actual: Array, command: Array) -> None:
        """Record one update."""
        times = np.array([time_ns], dtype=np.int64)
        if len(self._due(times)):
            self._stamps.append(times)
            rows = (samples.desired[:1], samples.desired_velocity[:1], actual[None, :], command[None, :])
            self._values.append(rows)

    def add_block(self, block: Block, start: int, samples: Samples, actual: Columns, command: Columns) -> None:
        """Record a block from `start` on; `actual` and `command` are columns of its states and commands."""
        rows = self._due(block.times_ns[start:]) + start
        if len(rows):
            self._stamps.append(block.times_ns[rows])
            values = (
                samples.desired[rows],
                samples.desired_velocity[rows],
                block.state[np.ix_(rows, actual)],
                block.command[np.ix_(rows, command)],
            )
            self._values.append(values)

    def recording(self) -> Recording:
        """Everything recorded so far."""
        if not self._stamps:
            empty = np.empty((0, len(self._joints)))
            return Recording(np.empty(0, dtype=np.int64), self._joints, empty, empty, empty, empty)
        columns = [np.concatenate([values[index] for values in self._values]) for index in range(4)]
        return Recording(np.concatenate(self._stamps), self._joints, *columns)
