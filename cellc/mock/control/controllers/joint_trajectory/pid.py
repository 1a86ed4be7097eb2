"""The PID of one joint that turns errors into velocity or effort commands (control_toolbox, parallel form)."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.control.hardware.ramp import clamp
from cellc.mock.control.parameters import ParameterSet


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
