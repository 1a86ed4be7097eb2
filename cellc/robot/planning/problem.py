"""What the planner takes and gives: planning groups and joint limits, paths, and the reasons why there is no path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass

Array = npt.NDArray[np.float64]
Configuration = tuple[float, ...]


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
    """Limits per joint in the group's order: rad, rad/s, rad/s², rad/s³, or meters for prismatic joints.

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

    def inside(self, configuration: Sequence[float], most: float) -> tuple[float, ...]:
        """Return a configuration in which joints are at their limit that are outside it by no more than ``most``."""
        bounds = zip(configuration, self.lower, self.upper, strict=True)
        near = ((value, min(max(value, lower), upper)) for value, lower, upper in bounds)
        return tuple(limit if abs(value - limit) <= most else value for value, limit in near)


@dataclass(frozen=True, slots=True)
class JointPath:
    """Sections of motion between standstills.

    A section of two waypoints is the straight edge between them in joint space. A section of more waypoints is the
    cubic spline through them; they have to be sampled evenly from a smooth motion, such as a straight line of the tip.
    Each section starts where the one before it ended.

    Attributes:
        joints: the order of every configuration.
        sections: waypoints, rad or meters.
    """

    joints: tuple[str, ...]
    sections: tuple[tuple[Configuration, ...], ...]

    @property
    def start(self) -> Configuration:
        """The first configuration."""
        return self.sections[0][0]

    @property
    def goal(self) -> Configuration:
        """The last configuration."""
        return self.sections[-1][-1]

    def then(self, other: JointPath) -> JointPath:
        """Return this path followed by another that starts where this one ends, with a standstill between them."""
        if other.joints != self.joints or other.start != self.goal:
            raise ValueError("a path must go on from the goal and with the joints of the path before it")
        return JointPath(self.joints, self.sections + other.sections)


class FailureReason(str, Enum):
    """The distinct reasons of a planning failure; the value is the word written to the attempt record."""

    NO_IK_SOLUTION = "no_ik_solution"
    GOAL_IN_COLLISION = "goal_in_collision"
    START_IN_COLLISION = "start_in_collision"
    OUT_OF_LIMITS = "out_of_limits"
    NO_PATH = "no_path"
    SINGULAR = "singular"
    JOINT_JUMP = "joint_jump"


@dataclass(frozen=True, slots=True)
class IkFailure:
    """No configuration puts the tip at the target."""

    reason: FailureReason
    detail: str


@dataclass(frozen=True, slots=True)
class PlanFailure:
    """No path leads from the start to the goal."""

    reason: FailureReason
    detail: str


class ModelError(CellcError, ValueError):
    """The robot description cannot be used; the message is one line and names the culprit."""


class UnknownShapeError(ModelError):
    """A collision shape names a mesh that is not there."""


class LimitsError(CellcError, ValueError):
    """A limit is zero, negative, not a number, or reversed; the message names the joint."""
