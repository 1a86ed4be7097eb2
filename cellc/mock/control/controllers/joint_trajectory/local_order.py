"""Bring the points of a trajectory into the order of the controller's joints, and fill in missing joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from cellc.mock.control.messages import Trajectory, TrajectoryPoint


def _spread(values: Sequence[float], places: Sequence[int], joints: int) -> tuple[float, ...]:
    spread = [0.0] * joints
    for value, place in zip(values, places, strict=False):
        # A joint that is named twice gets the last of its values.
        spread[place] = value
    return tuple(spread)


def _filled(point: TrajectoryPoint, missing: Sequence[float]) -> TrajectoryPoint:
    """Missing joints keep their position; the other fields are zero where they are in use."""
    zeros = (0.0,) * len(missing)
    return replace(
        point,
        positions=(*point.positions, *missing) if point.positions else (),
        velocities=(*point.velocities, *zeros) if point.velocities else (),
        accelerations=(*point.accelerations, *zeros) if point.accelerations else (),
        effort=(*point.effort, *zeros) if point.effort else (),
    )


def in_local_order(
    trajectory: Trajectory, joints: Sequence[str], positions: Sequence[float]
) -> tuple[tuple[TrajectoryPoint, ...], str]:
    """Sort a trajectory.

    Args:
        trajectory: an accepted trajectory.
        joints: joints of the controller.
        positions: positions that joints keep which the trajectory does not name.

    Returns:
        Its points in the order of `joints`, and a warning that the controller logs (empty for none).
    """
    names = list(trajectory.joint_names)
    points = list(trajectory.points)
    if len(names) < len(joints):
        absent = [index for index, joint in enumerate(joints) if joint not in names]
        points = [_filled(point, [positions[index] for index in absent]) for point in points]
        names.extend(joints[index] for index in absent)
    if len(names) > len(joints):
        return tuple(points), f"Invalid input size ({len(names)}) for sorting"
    if names == list(joints):
        return tuple(points), ""
    places = [list(joints).index(name) for name in names]
    return tuple(_sorted(point, places, len(joints)) for point in points), ""


def _sorted(point: TrajectoryPoint, places: Sequence[int], joints: int) -> TrajectoryPoint:
    return replace(
        point,
        positions=_spread(point.positions, places, joints) if point.positions else (),
        velocities=_spread(point.velocities, places, joints) if point.velocities else (),
        accelerations=_spread(point.accelerations, places, joints) if point.accelerations else (),
        effort=_spread(point.effort, places, joints) if point.effort else (),
    )
