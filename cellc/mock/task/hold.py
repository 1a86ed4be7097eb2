"""Cancels a goal and measures when the joints stand still."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.plant import Plant
from cellc.mock.record import CancelRecord
from cellc.mock.task.attempt import Attempt
from cellc.mock.task.bounds import cancel_bound_s
from cellc.mock.task.context import TaskContext
from cellc.mock.world.joint_states import JointStateHistory

STANDSTILL = 1e-3
"""rad/s or m/s below which a joint is held; far below what a person sees and above what rounding makes."""
_LOOK_NS = 10_000_000


def cancel_and_hold(
    context: TaskContext, attempt: Attempt, controller: str, goal_id: int, joints: tuple[str, ...]
) -> Waiting[bool]:
    """Cancel a goal, and wait until its joints stand still or the bound has passed.

    The wait goes on whatever else is wrong with the cell: a hold is what every failure has to end in.

    Returns:
        Whether the joints stood still within the bound; the record of the attempt says when.
    """
    plant = context.plant
    requested_ns = plant.now_ns
    return_code = _cancel(plant, controller, goal_id)
    until_ns = requested_ns + round(cancel_bound_s(plant.contract) * 1e9)
    held_ns = held_since(plant, joints, requested_ns)
    while held_ns is None and plant.now_ns < until_ns:
        yield Wait(min(until_ns, plant.now_ns + _LOOK_NS), (plant.control.changed,))
        held_ns = held_since(plant, joints, requested_ns)
    latency_s = None if held_ns is None else (held_ns - requested_ns) / 1e9
    attempt.cancel = CancelRecord(requested_ns, held_ns, latency_s, return_code)
    while (controller, goal_id) not in context.ended and plant.now_ns < until_ns:
        yield Wait(min(until_ns, plant.now_ns + _LOOK_NS), (plant.control.changed,))
    return held_ns is not None


def _cancel(plant: Plant, controller: str, goal_id: int) -> int | None:
    """Ask to cancel a goal, or every goal where another client has one too; return the answer, None for no answer."""
    if controller in plant.requests.unresponsive:
        return None
    manager = plant.control.server_of(controller)
    if any(name == controller for name, _ in plant.requests.foreign_goals):
        return manager.cancel_all(controller).return_code
    return manager.cancel_goal(goal_id).return_code


def held_since(plant: Plant, joints: Iterable[str], since_ns: int) -> int | None:
    """Return the first stamp from ``since_ns`` on from which all joints stand still until now; None while they move."""
    stamps = [
        _history_held_since(history, [joint for joint in joints if joint in history.names], since_ns)
        for history in plant.control.histories.values()
        if any(joint in history.names for joint in joints)
    ]
    known = [stamp for stamp in stamps if stamp is not None]
    return max(known) if known and len(known) == len(stamps) else None


def _history_held_since(history: JointStateHistory, joints: list[str], since_ns: int) -> int | None:
    first = max(0, int(np.searchsorted(history.stamps, since_ns)) - 1)
    stamps = history.stamps[first:]
    if len(stamps) < 3:
        return None
    columns = [history.names.index(joint) for joint in joints]
    seconds = np.diff(stamps) / 1e9
    speeds = np.abs(np.diff(history.positions[first:, columns], axis=0)) / seconds[:, None]
    moving = np.flatnonzero(speeds.max(axis=1) > STANDSTILL)
    settled = int(moving[-1]) + 1 if moving.size else 0
    if settled >= len(seconds):
        return None
    return max(since_ns, int(stamps[settled]))
