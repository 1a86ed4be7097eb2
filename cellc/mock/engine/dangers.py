"""Goals that the real controllers accept, and that nobody should send: OBSERVED answers that are plain defects."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.mock.control import GripperGoal, TrajectoryGoal


def dangers(controller: str, goal: TrajectoryGoal | GripperGoal) -> Iterator[str]:
    """Say of an accepted goal what makes it dangerous; nothing for a sound one."""
    if any(not math.isfinite(value) for value in _values(goal)):
        yield (
            f"dangerous: `{controller}` accepted a goal with NaN or an infinite value, as the real controller does; "
            "a joint of NaN stays where it is, and the goal succeeds"
        )
    if isinstance(goal, GripperGoal):
        return
    if len(set(goal.joint_names)) < len(goal.joint_names):
        yield (
            f"dangerous: `{controller}` accepted a goal that names a joint twice, as the real controller does; "
            "the last value counts, and a joint that is not named stays where it is"
        )
    if any(point.positions and point.accelerations and not point.velocities for point in goal.points):
        yield (
            f"dangerous: `{controller}` accepted accelerations without velocities, as the real controller does; its "
            "reference is zero for every joint until the last point"
        )


def _values(goal: TrajectoryGoal | GripperGoal) -> Iterator[float]:
    if isinstance(goal, GripperGoal):
        yield from (*goal.position, *goal.velocity, *goal.effort)
        return
    for point in goal.points:
        yield from (*point.positions, *point.velocities, *point.accelerations, *point.effort)
