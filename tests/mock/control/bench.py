"""A bench for single answers of the controllers: the small cell with other parameters, goals in one line."""

from __future__ import annotations

import json
from typing import TypeVar

from cellc.contract.vocabulary import Behavior, Distro
from cellc.mock.control import (
    ControlEvent,
    ControllerManager,
    GoalResponse,
    GoalStatus,
    JointTolerance,
    TrajectoryEnded,
    TrajectoryGoal,
    TrajectoryPoint,
)

from .arm_of_two import S, run, urdf

_Event = TypeVar("_Event", bound=ControlEvent)
Value = bool | int | float | str | list[str]

_TYPES = {
    "joints": "joint_state_broadcaster/JointStateBroadcaster",
    "arm": "joint_trajectory_controller/JointTrajectoryController",
    "hand": "parallel_gripper_action_controller/GripperActionController",
}
_ARM: dict[str, Value] = {
    "joints": ["a", "b"],
    "command_interfaces": ["position"],
    "state_interfaces": ["position", "velocity"],
    "constraints.goal_time": 0.5,
    "constraints.a.trajectory": 0.2,
    "constraints.b.trajectory": 0.2,
    "constraints.a.goal": 0.01,
    "constraints.b.goal": 0.01,
}
_HAND: dict[str, Value] = {"joint": "f", "goal_tolerance": 0.001, "stall_timeout": 0.3}


def parameters(
    arm: dict[str, Value] | None = None,
    hand: dict[str, Value] | None = None,
    *,
    types: dict[str, str] | None = None,
    manager: dict[str, object] | None = None,
) -> str:
    """The parameter file, with what differs from the usual one."""
    plugins = _TYPES | (types or {})
    declared = {name: {"type": plugin} for name, plugin in plugins.items()}
    return json.dumps(
        {
            "controller_manager": {"ros__parameters": {"update_rate": 500, **declared, **(manager or {})}},
            "arm": {"ros__parameters": _ARM | (arm or {})},
            "hand": {"ros__parameters": _HAND | (hand or {})},
        }
    )


def bench(
    arm: dict[str, Value] | None = None,
    hand: dict[str, Value] | None = None,
    *,
    types: dict[str, str] | None = None,
    distro: Distro = Distro.KILTED,
    description: str = "",
    start_ns: int = 0,
    behaviors: dict[str, Behavior] | None = None,
    up: tuple[str, ...] = ("joints", "arm", "hand"),
) -> ControllerManager:
    """Start the cell with parameters that differ from the usual ones, and let half a second pass."""
    text = parameters(arm, hand, types=types)
    manager = ControllerManager(
        description or urdf(), text, distro=distro, plugin_behaviors=behaviors or {}, start_ns=start_ns
    )
    if up:
        spawned = manager.spawn(list(up))
        assert spawned.ok, spawned
    run(manager, S // 2)
    return manager


def point(*positions: float, at: float = 1.0, v: tuple[float, ...] = (), a: tuple[float, ...] = ()) -> TrajectoryPoint:
    """A point; ``at`` in seconds from the start, ``v`` and ``a`` velocities and accelerations."""
    return TrajectoryPoint(tuple(positions), v, a, time_from_start_ns=round(at * S))


def send(
    manager: ControllerManager,
    *points: TrajectoryPoint,
    joints: tuple[str, ...] = ("a", "b"),
    stamp_ns: int = 0,
    path: tuple[JointTolerance, ...] = (),
    goal: tuple[JointTolerance, ...] = (),
    goal_time: float = 0.0,
) -> GoalResponse:
    """Send a goal to the arm."""
    sent = TrajectoryGoal(joints, points, stamp_ns, path, goal, round(goal_time * S))
    return manager.send_goal("arm", sent)


def only(events: list[ControlEvent], kind: type[_Event]) -> _Event:
    """Return the only event of a kind."""
    (found,) = (event for event in events if isinstance(event, kind))
    return found


def ending(manager: ControllerManager, within_s: float = 3.0) -> tuple[GoalStatus, int, str]:
    """Wait, and return how the only goal of the arm ended."""
    ended = only(run(manager, round(within_s * S)), TrajectoryEnded)
    return ended.status, ended.error_code, ended.error_string


def positions(manager: ControllerManager) -> tuple[float, float]:
    """The measured positions of the arm, in radians."""
    return manager.state("a/position"), manager.state("b/position")


def commands(manager: ControllerManager) -> tuple[float, float]:
    """The commanded positions of the arm, in radians."""
    return manager.command("a/position"), manager.command("b/position")


def wait(manager: ControllerManager, duration_s: float) -> list[ControlEvent]:
    """Let time pass, and return what happened."""
    return run(manager, round(duration_s * S))


__all__ = [
    "S",
    "bench",
    "commands",
    "ending",
    "only",
    "parameters",
    "point",
    "positions",
    "run",
    "send",
    "urdf",
    "wait",
]
