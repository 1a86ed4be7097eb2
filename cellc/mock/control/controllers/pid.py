"""PID of one joint (control_toolbox, parallel form), and the controller that follows references with it.

pid_controller/PidController is the lower part of a chain: another controller writes its references.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from cellc.mock.control.controllers.base import Context, Cycle, QuietController
from cellc.mock.control.hardware.joint_motion import clamp
from cellc.mock.control.interfaces import Block
from cellc.mock.control.parameters import Parameter, ParameterSet
from cellc.mock.control.parameters.declaration import not_empty, unique


@dataclass(slots=True)
class Pid:
    """Gains and the integral term of one joint."""

    p: float
    i: float
    d: float
    feed_forward: float
    output: tuple[float, float]
    integral: tuple[float, float]
    term: float = 0.0

    @staticmethod
    def of(parameters: ParameterSet, prefix: str) -> Pid:
        """Read the gains that stand below a prefix, ending in a dot."""
        number = parameters.number
        return Pid(
            number(f"{prefix}p"),
            number(f"{prefix}i"),
            number(f"{prefix}d"),
            number(f"{prefix}ff_velocity_scale"),
            (number(f"{prefix}u_clamp_min"), number(f"{prefix}u_clamp_max")),
            (number(f"{prefix}i_clamp_min"), number(f"{prefix}i_clamp_max")),
        )

    def command(self, error: float, error_rate: float, period_s: float) -> float:
        """The command for an error of position and its rate, without the feed forward."""
        self.term = clamp(self.term + self.i * error * period_s, *self.integral)
        return clamp(self.p * error + self.term + self.d * error_rate, *self.output)


_INFINITY = float("inf")


class PidController(QuietController):
    """A PID controller with one reference interface per degree of freedom.

    Args:
        context: what the manager gives.

    Raises:
        ParameterError: from the declaration of the parameters.
    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        parameters = context.parameters
        parameters.declare(
            (
                Parameter("dof_names", "string_array", [], (unique, not_empty), True),
                Parameter("reference_and_state_dof_names", "string_array", [], (unique,), True),
                Parameter("command_interface", "string", "", (not_empty,), True),
                Parameter("reference_and_state_interfaces", "string_array", [], (not_empty,), True),
            )
        )
        for name in parameters.texts("dof_names"):
            prefix = f"gains.{name}."
            parameters.declare(
                (
                    *(Parameter(prefix + key, "double", 0.0) for key in ("p", "i", "d", "ff_velocity_scale")),
                    *(Parameter(prefix + key, "double", _INFINITY) for key in ("u_clamp_max", "i_clamp_max")),
                    *(Parameter(prefix + key, "double", -_INFINITY) for key in ("u_clamp_min", "i_clamp_min")),
                )
            )

    def configure(self) -> None:
        """Read the gains."""
        parameters = self.context.parameters
        self._names = parameters.texts("dof_names")
        self._kind = parameters.texts("reference_and_state_interfaces")[0]
        self._pids = [Pid.of(parameters, f"gains.{name}.") for name in self._names]

    def command_interfaces(self) -> tuple[str, ...]:
        """The commanded interface of each degree of freedom."""
        kind = self.context.parameters.text("command_interface")
        return tuple(f"{name}/{kind}" for name in self._names)

    def state_interfaces(self) -> tuple[str, ...]:
        """The controlled state of each degree of freedom."""
        return tuple(f"{name}/{self._kind}" for name in self._names)

    def reference_interfaces(self) -> tuple[str, ...]:
        """One reference per degree of freedom."""
        return tuple(f"{self.context.name}/{name}/{self._kind}" for name in self._names)

    def activate(self, now_ns: int) -> None:
        """Start without references."""
        table = self.context.table
        self._references = table.command_columns(self.reference_interfaces())
        table.command[self._references] = math.nan

    def update(self, cycle: Cycle) -> None:
        """Command what brings the states to the references."""
        table = self.context.table
        references = table.command[self._references]
        states = table.state[table.state_columns(self.state_interfaces())]
        for index, column in enumerate(table.command_columns(self.command_interfaces()).tolist()):
            error = float(references[index] - states[index])
            if math.isfinite(error):
                self.context.command(column, self._pids[index].command(error, 0.0, cycle.period_ns / 1e9))

    def preview(self, block: Block) -> int:
        """Its commands depend on the states of each cycle: no block."""
        return 0
