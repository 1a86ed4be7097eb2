"""Commands of the controller: sampled one period ahead, directly or through a PID of each joint; and speed scaling."""

from __future__ import annotations

import math

import numpy as np

from cellc.mock.control.controllers.base import Context, Cycle
from cellc.mock.control.controllers.joint_trajectory.interfaces import JointInterfaces
from cellc.mock.control.controllers.joint_trajectory.motion import Motion, Samples
from cellc.mock.control.controllers.joint_trajectory.spline import StartState
from cellc.mock.control.controllers.pid import Pid
from cellc.mock.control.interfaces import Array, Block, Columns
from cellc.mock.control.journal import Cause


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
            (velocity,) = spline.velocities(*ahead)
            self._write_pid(samples, velocity, measured, cycle)
            return
        for kind, columns in self._interfaces.commands.items():
            if kind == "position":
                (wanted,) = samples.next
            elif kind == "velocity":
                (wanted,) = spline.velocities(*ahead)
            elif kind == "acceleration":
                (wanted,) = spline.accelerations(*ahead)
            else:
                wanted = np.zeros(len(columns))
            for column, value in zip(columns.tolist(), wanted.tolist(), strict=False):
                self._context.command(column, value)

    def _write_pid(self, samples: Samples, velocity: Array, measured: StartState, cycle: Cycle) -> None:
        (desired,), (desired_velocity,) = samples.desired, samples.desired_velocity
        error = self._interfaces.difference(desired, measured.position)
        rate = desired_velocity - (0.0 if measured.velocity is None else measured.velocity)
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


class SpeedScaling:
    """The scaling factor, from a parameter, a topic or a state interface.

    Args:
        context: the controller's context.
        scaled: whether `speed_scaling_interface_name` names the state interface where the upstream parameter does not;
            vendors' scaled controllers have the one or the other.
    """

    def __init__(self, context: Context, scaled: bool) -> None:
        parameters = context.parameters
        self._context = context
        self._state = parameters.text("speed_scaling.state_interface")
        if scaled and not self._state:
            self._state = parameters.text("speed_scaling_interface_name")
        self._command = parameters.text("speed_scaling.command_interface")
        self._column: int | None = None
        self.factor = parameters.number("speed_scaling.initial_scaling_factor")

    def state_names(self) -> tuple[str, ...]:
        """The state interface, if one is used."""
        return (self._state,) if self._state else ()

    def command_names(self) -> tuple[str, ...]:
        """The command interface, if one is used."""
        return (self._command,) if self._command else ()

    def bind(self) -> None:
        """Look up the state interface and read it."""
        self._column = self._context.table.state_column(self._state) if self._state else None
        self.read()

    def read(self) -> float:
        """The factor for this update; a value that is not known keeps the last one."""
        if self._column is not None:
            value = float(self._context.table.state[self._column])
            if not math.isnan(value):
                self._take(value)
        return self.factor

    def set(self, factor: float) -> None:
        """Take a factor of the topic `~/speed_scaling_input`; a negative one is ignored."""
        if factor < 0.0:
            return
        self._context.log.info(f"{self._context.name}.speed_scaling", f"New scaling factor will be {factor:f}")
        if self._command:
            self._context.command(self._context.table.command_column(self._command), factor)
        if self._column is None:
            self._take(factor, since_ns=1)  # it counts for the first update after this instant

    def _take(self, factor: float, since_ns: int = 0) -> None:
        if factor != self.factor:
            stamp_ns = self._context.log.now_ns + since_ns
            self._context.table.journal.note(stamp_ns, self._context.name, Cause.SCALING)
        self.factor = factor

    def unchanged(self, block: Block) -> int:
        """How many leading cycles of a block run with the present factor."""
        if self._column is None:
            return len(block)
        values = block.state[:, self._column]
        changed = (values != self.factor) & (values == values)
        index = int(changed.argmax())
        return index if changed[index] else len(block)
