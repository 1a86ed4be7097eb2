"""Execution of trajectories: controllers that MoveIt calls, and how it watches them."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.cell.cell import Cell
from cellc.cell.control import Controller
from cellc.cell.interface import ParameterValue

Parameters = Mapping[str, ParameterValue]

_MANAGER = "moveit_simple_controller_manager"
_TYPES = ("FollowJointTrajectory", "GripperCommand", "ParallelGripperCommand")


def controllers(cell: Cell) -> Parameters:
    """Return every active controller with an action that MoveIt knows; its name carries the namespace."""
    called = [controller for controller in cell.controllers if controller.active and _type(controller) in _TYPES]
    parameters: dict[str, ParameterValue] = {
        "moveit_controller_manager": f"{_MANAGER}/MoveItSimpleControllerManager",
        f"{_MANAGER}.controller_names": tuple(_name(controller) for controller in called),
    }
    for controller in called:
        prefix = f"{_MANAGER}.{_name(controller)}"
        parameters |= {
            f"{prefix}.type": _type(controller),
            f"{prefix}.action_ns": _suffix(controller),
            f"{prefix}.joints": controller.joints,
            f"{prefix}.default": True,
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


def _type(controller: Controller) -> str:
    return (controller.action_type or "").rpartition("/")[2]


def _name(controller: Controller) -> str:
    return (controller.action or "").lstrip("/").rpartition("/")[0]


def _suffix(controller: Controller) -> str:
    return (controller.action or "").rpartition("/")[2]
