"""Commands of the controller: sampled one period ahead, directly or through a PID of each joint."""

from __future__ import annotations

import numpy as np

from cellc.mock.control.block import Block
from cellc.mock.control.controllers.base import Context, Cycle
from cellc.mock.control.controllers.joint_trajectory.interfaces import JointInterfaces
from cellc.mock.control.controllers.joint_trajectory.motion import Motion, Samples
from cellc.mock.control.controllers.joint_trajectory.pid import Pid
from cellc.mock.control.controllers.joint_trajectory.spline import StartState
from cellc.mock.control.interfaces import Array, Columns


class JointCommands:
    """Writes the command interfaces.

    Args:
        context: the controller's context.
        interfaces: its interfaces.
    """

    def __init__(self, context: Context, interfaces: JointInterfaces) -> None:
        self._context = context
        self._interfaces = interfaces
        names = interfaces.joints if interfaces.uses_pid else ()
        self._pids = [Pid.of(context.parameters, f"gains.{name}.") for name in names]

    @property
    def depend_on_state(self) -> bool:
        """Whether commands follow from measured states, so that they cannot be computed ahead."""
        return bool(self._pids)

    def columns(self) -> Columns:
        """Columns of the first kind of command."""
        return next(iter(self._interfaces.commands.values()))

    def present(self) -> Array:
        """Present values of the first kind of command."""
        return self._context.table.command[self.columns()]

    def write(self, motion: Motion, samples: Samples, measured: StartState, cycle: Cycle) -> None:
        """Command one cycle."""
        spline, ahead = motion.spline, (samples.next_reached, samples.next_into)
        if self._pids:
            self._write_pid(samples, spline.velocities(*ahead)[0], measured, cycle)
            return
        for kind, columns in self._interfaces.commands.items():
            if kind == "position":
                wanted = samples.next[0]
            elif kind == "velocity":
                wanted = spline.velocities(*ahead)[0]
            elif kind == "acceleration":
                wanted = spline.accelerations(*ahead)[0]
            else:
                wanted = np.zeros(len(columns))
            for column, value in zip(columns.tolist(), wanted.tolist(), strict=False):
                self._context.command(column, value)

    def _write_pid(self, samples: Samples, velocity: Array, measured: StartState, cycle: Cycle) -> None:
        error = self._interfaces.difference(samples.desired[0], measured.position)
        rate = samples.desired_velocity[0] - (0.0 if measured.velocity is None else measured.velocity)
        for index, column in enumerate(self.columns().tolist()):
            pid = self._pids[index]
            correction = pid.command(float(error[index]), float(rate[index]), cycle.period_ns / 1e9)
            self._context.command(column, float(velocity[index]) * pid.feed_forward + correction)

    def preview(self, motion: Motion, samples: Samples, block: Block) -> None:
        """Write the commands of all cycles of a block."""
        spline, ahead = motion.spline, (samples.next_reached, samples.next_into)
        for kind, columns in self._interfaces.commands.items():
            if kind == "position":
                block.command[:, columns] = samples.next[:, : len(columns)]
            elif kind == "velocity":
                block.command[:, columns] = spline.velocities(*ahead)
            elif kind == "acceleration":
                block.command[:, columns] = spline.accelerations(*ahead)
            else:
                block.command[:, columns] = 0.0
