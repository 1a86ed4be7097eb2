"""What ``cellc show`` says of values, and where each is from: files of the corpus, read by a person."""

from __future__ import annotations

from functools import cache

import pytest

from cellc.tools.report.resolved import flatten, resolved_tree
from tests.cells import COMPLETE, ROOT, linked

PARTS = (COMPLETE.parent / "parts").relative_to(ROOT).as_posix()
ARM = "catalog devices/demo_arm"
LIMITS = f"{PARTS}/devices_arm.yaml:12 of {ARM}"


@cache
def _shown() -> dict[str, tuple[str, str]]:
    tree = resolved_tree(linked(COMPLETE))
    return {name: (leaf.text, leaf.origin.replace(f"{ROOT.as_posix()}/", "")) for name, leaf in flatten(tree)}


@pytest.mark.parametrize(
    ("name", "text", "origin"),
    [
        ("cell", "demo", "tests/corpus/valid/complete.yaml:3"),
        ("devices.arm.transform_root_to_parent", "xyz 0 0 0.8 m, rpy 0 0 0 deg", f"{PARTS}/devices_arm.yaml:4"),
        ("devices.arm.prefix", "arm_", "default"),
        ("devices.arm.frames.tool0", "arm_tool0", ARM),
        ("devices.arm.joints.arm_joint_1.upper", "6.2831853", ARM),
        ("devices.arm.joints.arm_joint_1.velocity", "1.5", LIMITS),  # half of 3 rad/s
        ("devices.arm.joints.arm_joint_1.acceleration", "2.5", LIMITS),  # half of 5 rad/s^2
        ("devices.arm.joints.arm_joint_1.command_interfaces", "[position, velocity]", ARM),
        ("frames.tcp.transform_to_parent", "xyz 0 0 0.162 m, rpy 0 0 0 deg", f"{PARTS}/frames_tcp.yaml:2"),
        ("frames.tcp.kind", "fixed", f"{PARTS}/frames_tcp.yaml:2"),
        ("frames.arm_tool0.kind", "link", ARM),
        ("frames.object.authority", "perception", f"{PARTS}/frames_object.yaml:5"),
        ("frames.object.moving", "true", f"{PARTS}/frames_object.yaml:2"),
        ("interfaces./object_pose.kind", "topic", f"{PARTS}/interfaces_object_pose.yaml:3"),
        ("interfaces./object_pose.type", "geometry_msgs/msg/PoseStamped", f"{PARTS}/interfaces_object_pose.yaml:3"),
        ("interfaces./object_pose.sources.0.qos.depth", "1", f"{PARTS}/interfaces_object_pose.yaml:4"),
        ("interfaces./object_pose.sinks.0.node", "task", f"{PARTS}/interfaces_object_pose.yaml:5"),
        ("interfaces./object_pose.sinks.0.qos.deadline_s", "none", f"{PARTS}/interfaces_object_pose.yaml:5"),
        ("interfaces./object_pose.max_age_s", "0.2", f"{PARTS}/interfaces_object_pose.yaml:9"),
        ("interfaces./move_action.kind", "action", f"{PARTS}/interfaces_move_action.yaml:3"),
        ("interfaces./move_action.sources.0.node", "move_group", f"{PARTS}/interfaces_move_action.yaml:4"),
        ("interfaces./tf.type", "tf2_msgs/msg/TFMessage", "catalog interfaces"),
        ("managers.control.update_rate_hz", "500", f"{PARTS}/control.yaml:2"),
        ("controllers.arm_trajectory.kind", "scaled_joint_trajectory", f"{PARTS}/control.yaml:7"),
        ("controllers.arm_trajectory.targets", "[mock, real]", "default"),
        ("calibrations.hand_eye.residual", "0.8 mm", f"{PARTS}/calibrations_hand_eye.yaml:2"),
        ("calibrations.hand_eye.file", "none", "default"),
        ("safety.recovery.on_reconnect", "discard_goal", "default"),
    ],
)
def test_value_and_its_origin(name: str, text: str, origin: str) -> None:
    assert _shown()[name] == (text, origin)
