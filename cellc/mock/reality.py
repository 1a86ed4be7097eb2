"""How a run differs from its folder: real poses, readings of clocks, loads, and the distance from tip to goal.

The description, TF and the planner keep the poses of the folder: what the robot assumes. Only the world has the real
poses, so that a wrong calibration moves the robot to a wrong place, as in the real cell.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3


@dataclass(frozen=True, slots=True)
class Displacement:
    """How far an object lies from where it is said to: m along the parent's axes, and turned about its own origin."""

    along: Vector3
    turned: Pose


@dataclass(frozen=True, slots=True)
class OtherPart:
    """By how much a part is heavier than the scene has it, and its surface has more friction."""

    more_kg: float = 0.0
    more_friction: float = 0.0


@dataclass(frozen=True, slots=True)
class Reality:
    """What is different in one run.

    Attributes:
        links: child frame → where it really is, seen from where the description has it.
        objects: dynamic frame → how far its object is displaced.
        offsets_s: clock → how much more it reads.
        part_more_kg: device → by which the part of its tool is heavier.
        compensation: device → share by which it compensates its weight too much.
        tool_more_kg: device → by which its tool is heavier than its controller knows.
        parts: frame → how the part there differs from the scene.
        noise: seed of what is drawn again for every sample, by networks and joints; None for that of the run.
    """

    links: Mapping[str, Pose] = field(default_factory=dict)
    objects: Mapping[str, Displacement] = field(default_factory=dict)
    offsets_s: Mapping[str, float] = field(default_factory=dict)
    part_more_kg: Mapping[str, float] = field(default_factory=dict)
    compensation: Mapping[str, float] = field(default_factory=dict)
    tool_more_kg: Mapping[str, float] = field(default_factory=dict)
    parts: Mapping[str, OtherPart] = field(default_factory=dict)
    noise: int | None = None


AS_STATED = Reality()
"""Everything is where the folder says."""


@dataclass(frozen=True, slots=True)
class Arrival:
    """A motion to a goal has ended: how far the tip really is from where the goal really is, and what room is left.

    Attributes:
        singular_value: least of the tip's Jacobian, rows in m and rad: 0 at the end of the arm's reach.
        joint_room: least share of its range that a joint of the group has left to the nearer end; None without limits.
        clearance_m: from what the group moves to what it does not, where the description has that; None without shapes.
        transform_age_s: of the transform that the goal was looked up by.
    """

    goal: str
    stamp_ns: int
    distance_m: float
    singular_value: float
    joint_room: float | None
    clearance_m: float | None
    transform_age_s: float | None
