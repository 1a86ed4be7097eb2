"""Goals for a device behind an adapter: read as a trajectory, and refused before motion where a command would be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from cellc.adapter import (
    AdapterModel,
    DeviceState,
    JointCommand,
    JointModel,
    Phase,
    Trajectory,
    Unit,
    Waypoint,
    check_command,
)
from cellc.contract.adapter import ContractAdapter
from cellc.contract.contract import ContractJointLimits
from cellc.mock.control import TrajectoryGoal, TrajectoryPoint

START_TOLERANCE = 0.01
"""rad or m by which the first point may be away from where the joints stand, where it is due at once."""
_UNBOUNDED = float("inf")


def adapter_model(
    device: str, facts: ContractAdapter, limits: Mapping[str, ContractJointLimits], clock: str
) -> AdapterModel:
    """Return what the adapter of a device states, with the limits of the cell as bounds of its commands."""
    joints: list[JointModel] = []
    for name, unit in zip(facts.joints, facts.units, strict=True):
        limit = limits.get(name)
        lower = -_UNBOUNDED if limit is None or limit.lower is None else limit.lower
        upper = _UNBOUNDED if limit is None or limit.upper is None else limit.upper
        joints.append(JointModel(name, Unit(unit), lower, upper, _UNBOUNDED if limit is None else limit.velocity))
    return AdapterModel(
        device, tuple(joints), clock, facts.command_period_s, facts.command_timeout_s, facts.stop_time_s
    )


def read_goal(goal: TrajectoryGoal, model: AdapterModel, state: DeviceState) -> Trajectory:
    """Return the trajectory of a goal, from where the joints stand.

    Raises:
        ValueError: a joint or a value is missing, the times do not rise, or a first point due at once is elsewhere.
    """
    if sorted(goal.joint_names) != sorted(model.joint_names):
        raise ValueError(f"the goal names {', '.join(goal.joint_names)}; `{model.device}` moves all of its joints")
    order = [goal.joint_names.index(name) for name in model.joint_names]
    points = [_waypoint(point, order) for point in goal.points]
    if points and points[0].time_s == 0.0:
        away = max(abs(a - b) for a, b in zip(points[0].positions, state.positions, strict=True))
        if away > START_TOLERANCE:
            raise ValueError(f"the trajectory begins {away:.4g} away from where the joints stand")
        at_once, points = points[0], points[1:]
        # A goal that is reached already is a trajectory of one period.
        points = points or [replace(at_once, time_s=model.command_period_s)]
    zero = (0.0,) * len(order)
    return Trajectory((Waypoint(0.0, state.positions, zero, zero), *points))


def first_refusal(trajectory: Trajectory, model: AdapterModel) -> str:
    """Return why a command of a trajectory would be refused; empty where each one is within bounds."""
    last = trajectory.positions(0.0)
    for period in range(1, int(trajectory.duration_s / model.command_period_s) + 2):
        positions = trajectory.positions(period * model.command_period_s)
        refusal = check_command(model, JointCommand(0, positions), phase=Phase.ACTIVE, last=last, now_ns=0)
        if refusal is not None:
            return refusal.text
        last = positions
    return ""


def _waypoint(point: TrajectoryPoint, order: list[int]) -> Waypoint:
    values = (point.positions, point.velocities, point.accelerations)
    if any(len(each) != len(order) for each in values):
        raise ValueError("a point lacks positions, velocities or accelerations")
    positions, velocities, accelerations = (tuple(each[index] for index in order) for each in values)
    return Waypoint(point.time_from_start_ns / 1e9, positions, velocities, accelerations)
