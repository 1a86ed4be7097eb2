"""Interfaces that no spec states: what follows from nodes, controllers and frames, by hand from the complete cell.

robot_state_publisher publishes the description latched, and static transforms; managers read the description; who
publishes a dynamic frame publishes /tf; trajectory and gripper controllers serve their action to their client.
"""

from __future__ import annotations

import pytest

from tests.cells import COMPLETE, linked

_STATE_PUBLISHER = "robot_state_publisher"
_DERIVED = {
    "/tf": ("tf2_msgs/msg/TFMessage", {_STATE_PUBLISHER, "perception"}, {"move_group", "task"}),
    "/tf_static": ("tf2_msgs/msg/TFMessage", {_STATE_PUBLISHER}, {"move_group", "task"}),
    "/robot_description": ("std_msgs/msg/String", {_STATE_PUBLISHER}, {"controller_manager"}),
    "/joint_states": ("sensor_msgs/msg/JointState", {"joint_states"}, {_STATE_PUBLISHER, "move_group", "task"}),
    "/arm_trajectory/follow_joint_trajectory": (
        "control_msgs/action/FollowJointTrajectory",
        {"arm_trajectory"},
        {"move_group"},
    ),
    "/gripper_action/gripper_cmd": ("control_msgs/action/ParallelGripperCommand", {"gripper_action"}, {"task"}),
}


@pytest.mark.parametrize("name", _DERIVED)
def test_derived_interface_has_its_type_and_ends(name: str) -> None:
    (found,) = (interface for interface in linked(COMPLETE).interfaces if interface.name == name)
    type_, sources, sinks = _DERIVED[name]
    assert found.type == type_
    assert ({end.node for end in found.sources}, {end.node for end in found.sinks}) == (sources, sinks)


def test_nothing_else_is_derived() -> None:
    stated = {"/camera/camera/color/image_raw", "/object_pose", "/move_action"}
    assert {interface.name for interface in linked(COMPLETE).interfaces} - stated == set(_DERIVED)


def test_latched_ends_are_latched() -> None:
    """The description and static transforms are there for nodes that start later: transient local, depth 1."""
    for interface in linked(COMPLETE).interfaces:
        if interface.name in ("/robot_description", "/tf_static"):
            for end in interface.sources:
                assert (end.qos.reliability, end.qos.durability, end.qos.depth) == ("reliable", "transient_local", 1)
