"""Records the state of the controller, thinned to a given rate, for plots and bags."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.mock.control.controllers.joint_trajectory.interfaces import JointInterfaces
from cellc.mock.control.controllers.joint_trajectory.motion import Samples
from cellc.mock.control.interfaces import Array, Block, Columns, Times


@dataclass(frozen=True, slots=True)
class Recording:
    """Successive states of a trajectory controller.

    Attributes:
        stamps_ns: times of the updates, shape (m,).
        joints: names of the joints.
        desired: desired positions, shape (m, joints).
        desired_velocity: desired velocities.
        actual: measured positions.
        actual_velocity: measured velocities, NaN where the controller does not read them.
        error: desired - actual, for continuous joints the shortest way round.
        command: commanded values of the first command interface, after limits, as the state topic shows them: the
            last ones from before while a wanted command holds NaN, and NaN, for a field that stays empty, afterwards.
        scaling: speed scaling factor, shape (m,).
    """

    stamps_ns: Times
    joints: tuple[str, ...]
    desired: Array
    desired_velocity: Array
    actual: Array
    actual_velocity: Array
    error: Array
    command: Array
    scaling: Array


class Recorder:
    """Collects the updates of a controller.

    Args:
        interfaces: of the controller.
        period_ns: time between two records at least.
    """

    def __init__(self, interfaces: JointInterfaces, period_ns: int) -> None:
        self._interfaces = interfaces
        self._period_ns = period_ns
        self._next_ns = 0
        self._kept: list[Recording] = []
        self._shown: Array | None = None
        self._held_nan = False

    def add_update(self, time_ns: int, samples: Samples, state: Array, command: Array, factor: float) -> None:
        """Record one update; ``state`` has all state interfaces, ``command`` those of the first kind."""
        times = np.array([time_ns], dtype=np.int64)
        shown = self._output(samples.next, command[None, :])
        if len(self._due(times)):
            self._keep(times, samples, np.array([0]), state[None, :], shown, factor)

    def add_block(self, block: Block, start: int, samples: Samples, command: Columns, factor: float) -> None:
        """Record a block from `start` on; `command` are columns of its commands."""
        shown = self._output(samples.next[start : len(block)], block.command[start:, command])
        rows = self._due(block.times_ns[start:])
        if len(rows):
            indices = rows + start
            self._keep(block.times_ns[indices], samples, indices, block.state[indices], shown[rows], factor)

    def _output(self, wanted: Array, command: Array) -> Array:
        """Return what the state topic shows of successive commands.

        Recorded of ros2_controllers 5.17: the field is not renewed while a wanted command holds NaN, and stays empty
        from the first one that does not.
        """
        if not self._held_nan and not np.isnan(wanted).any():
            self._shown = np.array(command[-1])
            return command
        invalid: list[bool] = [bool(np.isnan(row).any()) for row in wanted]
        shown: Array = np.array(command)
        for row in range(len(command)):
            if invalid[row] and self._shown is not None:
                shown[row], self._held_nan = self._shown, True
            elif self._held_nan:
                self._shown = np.full(command.shape[1], np.nan)
                shown[row] = self._shown
            else:
                self._shown = np.array(command[row])
        return shown

    def recording(self) -> Recording:
        """Return everything that was recorded and not taken."""
        if not self._kept:
            empty = np.empty((0, len(self._interfaces.joints)))
            stamps = np.empty(0, dtype=np.int64)
            return Recording(stamps, self._interfaces.joints, empty, empty, empty, empty, empty, empty, np.empty(0))
        names = [field.name for field in fields(Recording) if field.name != "joints"]
        columns = {name: np.concatenate([getattr(part, name) for part in self._kept]) for name in names}
        return Recording(joints=self._interfaces.joints, **columns)

    def take(self) -> Recording:
        """Hand over what was recorded since the last time."""
        recording = self.recording()
        self._kept.clear()
        return recording

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

    def _keep(
        self, times_ns: Times, samples: Samples, rows: Columns, state: Array, command: Array, factor: float
    ) -> None:
        places = self._interfaces.states
        desired, actual = samples.desired[rows], state[:, places["position"]]
        velocity = state[:, places["velocity"]] if "velocity" in places else np.full(actual.shape, np.nan)
        self._kept.append(
            Recording(
                stamps_ns=times_ns,
                joints=self._interfaces.joints,
                desired=desired,
                desired_velocity=samples.desired_velocity[rows],
                actual=actual,
                actual_velocity=velocity,
                error=self._interfaces.difference(desired, actual),
                command=command,
                scaling=np.full(len(times_ns), factor),
            )
        )
