"""Acceptance of trajectories, check by check in the real controller's order, and the order of their joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from cellc.contract.frozen import dataclass
from cellc.mock.control.messages import Trajectory, TrajectoryPoint

# The real comparison is against the float epsilon.
_FLOAT_EPSILON = 1.1920929e-07


@dataclass(frozen=True, slots=True)
class AcceptanceRules:
    """What the controller allows in a trajectory."""

    joints: tuple[str, ...]
    partial_joints: bool
    integration: bool
    nonzero_end_velocity: bool
    has_effort_command: bool


def refusal(trajectory: Trajectory, rules: AcceptanceRules, now_ns: int) -> str:
    """Say why a trajectory is refused.

    Args:
        trajectory: the trajectory as sent.
        rules: what the controller allows.
        now_ns: the present time.

    Returns:
        The reason as the controller logs it, empty for a trajectory that is accepted.
    """
    return (
        _names_refusal(trajectory, rules)
        or _end_refusal(trajectory, rules, now_ns)
        or _points_refusal(trajectory, rules)
    )


def _names_refusal(trajectory: Trajectory, rules: AcceptanceRules) -> str:
    names = trajectory.joint_names
    if not rules.partial_joints and len(names) != len(rules.joints):
        return "Joints on incoming trajectory don't match the controller joints."
    if not names:
        return "Empty joint names on incoming trajectory."
    if not trajectory.points:
        return "Empty trajectory received."
    for name in names:
        if name not in rules.joints:
            return f"Incoming joint {name} doesn't match the controller's joints."
    return ""


def _end_refusal(trajectory: Trajectory, rules: AcceptanceRules, now_ns: int) -> str:
    last = trajectory.points[-1]
    if not rules.nonzero_end_velocity:
        # A list of another length than the joints is found by a later check.
        for name, velocity in zip(trajectory.joint_names, last.velocities, strict=False):
            if abs(velocity) > _FLOAT_EPSILON:
                return f"Velocity of last trajectory point of joint {name} is not zero: {velocity:.15f}"
    end_ns = trajectory.stamp_ns + last.time_from_start_ns
    if trajectory.stamp_ns != 0 and end_ns < now_ns:
        return (
            f"Received trajectory with non-zero start time ({trajectory.stamp_ns / 1e9:f}) "
            f"that ends in the past ({end_ns / 1e9:f})"
        )
    return ""


def _points_refusal(trajectory: Trajectory, rules: AcceptanceRules) -> str:
    previous_ns: int | None = None
    for index, point in enumerate(trajectory.points):
        if previous_ns is not None and point.time_from_start_ns <= previous_ns:
            return (
                f"Time between points {index - 1} and {index} is not strictly increasing, it is "
                f"{previous_ns / 1e9:f} and {point.time_from_start_ns / 1e9:f} respectively"
            )
        previous_ns = point.time_from_start_ns
        reason = _sizes_refusal(point, len(trajectory.joint_names), rules, index)
        if reason:
            return reason
    return ""


def _sizes_refusal(point: TrajectoryPoint, joints: int, rules: AcceptanceRules, index: int) -> str:
    integrated = rules.integration and not point.positions and (point.velocities or point.accelerations)
    fields: list[tuple[str, Sequence[float], bool]] = [
        ("positions", point.positions, bool(integrated)),
        ("velocities", point.velocities, True),
        ("accelerations", point.accelerations, True),
    ]
    for name, values, may_be_empty in fields:
        if len(values) != joints and not (may_be_empty and not values):
            return f"Mismatch between joint_names size ({joints}) and {name} ({len(values)}) at point #{index}."
    if point.effort and not rules.has_effort_command:
        return (
            "Trajectories with effort fields are only supported for controllers using the 'effort' command interface."
        )
    if point.effort and len(point.effort) != joints:
        return f"Mismatch between joint_names size ({joints}) and effort ({len(point.effort)}) at point #{index}."
    return ""


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
