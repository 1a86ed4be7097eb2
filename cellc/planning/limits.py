"""Planning groups and the limits of their joints."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from cellc.planning.failure import LimitsError

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PlanningGroup:
    """The joints that move a tip link, as an SRDF group of one chain.

    Attributes:
        joints: in the order of every configuration of this group.
        base_link: targets are expressed in the frame of this link.
        tip_link: the link whose frame reaches the target.
    """

    name: str
    joints: tuple[str, ...]
    base_link: str
    tip_link: str


@dataclass(frozen=True, slots=True)
class JointLimits:
    """Limits per joint in the group's order: rad, rad/s, rad/s², rad/s³, or metres for prismatic joints.

    A continuous joint has the position limits -inf and +inf.

    Raises:
        LimitsError: a limit is not a number, not positive, reversed, or missing.
    """

    joints: tuple[str, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    jerk: tuple[float, ...]

    def __post_init__(self) -> None:
        for kind in ("lower", "upper", "velocity", "acceleration", "jerk"):
            values: tuple[float, ...] = getattr(self, kind)
            if len(values) != len(self.joints):
                raise LimitsError(f"{len(values)} {kind} limits for {len(self.joints)} joints")
        for joint, lower, upper in zip(self.joints, self.lower, self.upper, strict=True):
            if not lower < upper:
                raise LimitsError(f"joint `{joint}` has the position limits {lower} to {upper}")
        for kind in ("velocity", "acceleration", "jerk"):
            for joint, value in zip(self.joints, getattr(self, kind), strict=True):
                if not (math.isfinite(value) and value > 0.0):
                    raise LimitsError(f"joint `{joint}` has the {kind} limit {value}, not a finite positive one")

    def scaled(self, velocity: float = 1.0, acceleration: float = 1.0) -> JointLimits:
        """Return slower limits, as MoveIt's scaling factors do; jerk follows the acceleration factor."""
        return replace(
            self,
            velocity=tuple(velocity * value for value in self.velocity),
            acceleration=tuple(acceleration * value for value in self.acceleration),
            jerk=tuple(acceleration * value for value in self.jerk),
        )

    def violation(self, configuration: Array) -> str:
        """Say which joint of a configuration is outside its position limits; empty where none is."""
        for joint, value, lower, upper in zip(self.joints, configuration, self.lower, self.upper, strict=True):
            if not lower <= value <= upper:
                return f"joint `{joint}` at {value:.6g} is outside {lower:.6g} to {upper:.6g}"
        return ""
