"""Execution of trajectories: controllers that MoveIt calls, and how it watches them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.interface import ParameterValue
from cellc.deploy.files import is_planner

Parameters = Mapping[str, ParameterValue]

_MANAGER = "moveit_simple_controller_manager"
_TYPES = ("FollowJointTrajectory", "GripperCommand", "ParallelGripperCommand")


@dataclass(frozen=True, slots=True)
class _Called:
    """An action that MoveIt calls: its full name and type, and the joints that it moves."""

    action: str
    type: str
    joints: tuple[str, ...]


def controllers(cell: Cell, target: str) -> Parameters:
    """Return what executes on a target: active controllers with an action that MoveIt knows, and what stands in."""
    called = {_name(cell, one): one for one in _called(cell, target) if _short(one.type) in _TYPES}
    parameters: dict[str, ParameterValue] = {
        "moveit_controller_manager": f"{_MANAGER}/MoveItSimpleControllerManager",
        f"{_MANAGER}.controller_names": tuple(called),
    }
    for name, one in called.items():
        parameters |= {
            f"{_MANAGER}.{name}.type": _short(one.type),
            f"{_MANAGER}.{name}.action_ns": one.action.rpartition("/")[2],
            f"{_MANAGER}.{name}.joints": one.joints,
            f"{_MANAGER}.{name}.default": True,
        }
    return parameters


def trajectory_execution(cell: Cell) -> Parameters:
    """Return how execution is watched.

    A device that slows trajectories down outlasts the planned duration: there MoveIt must not abort for it, and the
    controller's own tolerances watch instead.
    """
    slowed = any(device.facts.speed_scaling is not None for device in cell.devices)
    return {
        # Switching is a declared step of the cell, never a side effect of planning.
        "moveit_manage_controllers": False,
        "trajectory_execution.execution_duration_monitoring": not slowed,
        "trajectory_execution.allowed_execution_duration_scaling": 1.2,
        "trajectory_execution.allowed_goal_duration_margin": 0.5,
        "trajectory_execution.allowed_start_tolerance": 0.01,
        "trajectory_execution.wait_for_trajectory_completion": True,
    }


def planning_scene() -> Parameters:
    """Return what move_group tells of its scene; the description's publisher is robot_state_publisher alone."""
    return {
        "publish_planning_scene": True,
        "publish_geometry_updates": True,
        "publish_state_updates": True,
        "publish_transforms_updates": True,
        "publish_robot_description": False,
        "publish_robot_description_semantic": True,
    }


def _called(cell: Cell, target: str) -> Iterator[_Called]:
    for one in cell.controllers:
        if one.active and target in one.targets and one.action is not None:
            yield _Called(one.action, one.action_type or "", one.joints)
        elif one.active and target == "real" and one.stand_in is not None:
            yield _Called(one.stand_in.action, one.stand_in.action_type, one.joints)


def _name(cell: Cell, called: _Called) -> str:
    """Return the name below which MoveIt looks for the action, with the namespace of who serves it.

    It is relative to move_group: with its slash where that is in a namespace of its own.
    """
    name = called.action.rpartition("/")[0]
    return name if any(is_planner(node) and node.namespace for node in cell.nodes) else name.removeprefix("/")


def _short(type_: str) -> str:
    return type_.rpartition("/")[2]
