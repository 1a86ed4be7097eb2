"""What a parser makes of a robot description, in terms that all parsers share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.transforms import Pose


@dataclass(frozen=True, slots=True)
class JointReading:
    """Limits of one movable joint, in rad or m; a joint without position bounds has infinite ones."""

    lower: float
    upper: float
    velocity: float
    effort: float


@dataclass(frozen=True, slots=True)
class Reading:
    """Joints by name, and the pose of every link in the root link, by name.

    Args:
        at_zero: poses with every joint at position zero.
        displaced: poses with every joint at the position that `displaced_positions` gives it.
    """

    joints: Mapping[str, JointReading]
    at_zero: Mapping[str, Pose]
    displaced: Mapping[str, Pose]


class RefusedError(Exception):
    """A parser refuses the description."""


def displaced_positions(joints: Mapping[str, str | None]) -> dict[str, float]:
    """Return a position away from zero for each joint, by which axes and signs show.

    Args:
        joints: movable joints by name, each with the joint that it mimics or None. A mimic joint gets none: what
            it does follows from the other.
    """
    free = sorted(name for name, mimicked in joints.items() if mimicked is None)
    return {name: 0.1 + 0.05 * (index % 7) for index, name in enumerate(free)}
