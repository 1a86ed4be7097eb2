"""Limits that the joint limiters enforce: URDF and command interfaces together."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cellc.mock.control.description.component import PartInfo
from cellc.mock.control.description.urdf import UrdfJoint


@dataclass(frozen=True, slots=True)
class JointLimits:
    """Limits of one joint; infinite where there is none.

    Attributes:
        lower: rad or m.
        upper: rad or m.
        velocity: rad/s or m/s, symmetric.
        effort: N m or N, symmetric.
        acceleration: rad/s² or m/s².
        deceleration: rad/s² or m/s².
    """

    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    effort: float = math.inf
    acceleration: float = math.inf
    deceleration: float = math.inf

    @property
    def has_position(self) -> bool:
        """Whether the position is limited."""
        return math.isfinite(self.lower) or math.isfinite(self.upper)


def _bound(text: str, default: float) -> float:
    """A `min` or `max`; text that is no number is skipped by ros2_control."""
    try:
        return float(text)
    except ValueError:
        return default


def joint_limits(joint: UrdfJoint, part: PartInfo) -> JointLimits:
    """Combine the limits of the URDF with those of the command interfaces, the narrower one winning.

    Args:
        joint: the joint of the URDF.
        part: the joint inside `<ros2_control>`.

    Returns:
        The limits; none at all with `<limits enable="false"/>` in the joint.
    """
    if not part.limits_enabled:
        return JointLimits()
    lower, upper, velocity, effort = -math.inf, math.inf, math.inf, math.inf
    acceleration = deceleration = math.inf
    if joint.limit is not None:
        velocity, effort = joint.limit.velocity, joint.limit.effort
        if joint.type in ("revolute", "prismatic"):
            lower, upper = joint.limit.lower, joint.limit.upper
    for interface in part.command_interfaces:
        minimum, maximum = _bound(interface.minimum, -math.inf), _bound(interface.maximum, math.inf)
        symmetric = min(abs(minimum), abs(maximum))
        if interface.name == "position":
            lower, upper = max(lower, minimum), min(upper, maximum)
        elif interface.name == "velocity":
            velocity = min(velocity, symmetric)
        elif interface.name == "effort":
            effort = min(effort, symmetric)
        elif interface.name == "acceleration":
            acceleration, deceleration = abs(maximum), abs(minimum)
    return JointLimits(lower, upper, velocity, effort, acceleration, deceleration)
