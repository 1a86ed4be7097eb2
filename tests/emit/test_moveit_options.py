"""An occupancy map and MoveIt Servo, as MoveIt's own declarations of parameters ask for them."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

import pytest

from tests.cells import spec_text
from tests.consumers.permissions import policy_of
from tests.emit.cells import contract_data, emitted
from tests.foreign_yaml import safe_load

_SERVO = """
  servo: {node: servo, controller: arm_jog, linear: 50 mm/s, rotational: 0.2 rad/s, joint: 0.1 rad/s, period: 4 ms}
"""
_OCTOMAP = "  octomap: {source: /camera/depth/image_rect_raw, resolution: 25 mm, range: 2 m, padding: 30 mm}\n"
_HEARD = """
    from: camera
    to: {move_group: {reliability: best_effort, depth: 1}}
    wants: newest
    rate: 30 Hz
    max_age: 200 ms
    on_stale: reject_goal"""
_DEPTH = f"""
  /camera/depth/image_rect_raw:
    topic: sensor_msgs/msg/Image{_HEARD}
  /camera/depth/camera_info:
    topic: sensor_msgs/msg/CameraInfo{_HEARD}
"""
# moveit2, what setParams reads of each updater, all of it required: 2.12.4
# moveit_ros/perception/depth_image_octomap_updater/src/depth_image_octomap_updater.cpp:37-48, 2.5.9 :35-46.
_OF_IMAGE = {
    *("image_topic", "queue_size", "near_clipping_plane_distance", "far_clipping_plane_distance", "shadow_threshold"),
    *("padding_scale", "padding_offset", "max_update_rate", "skip_vertical_pixels", "skip_horizontal_pixels"),
    *("filtered_cloud_topic", "ns", "sensor_plugin"),
}


def _spec(distro: str) -> str:
    program = "servo_node_main" if distro == "humble" else "servo_node"
    text = spec_text("ur5e_pick").replace("ros: jazzy", f"ros: {distro}")
    text = text.replace(
        "  move_group: {", f"  servo: {{run: moveit_servo/{program}, owner: integration}}\n  move_group: {{", 1
    )
    text = text.replace("\ninterfaces:\n", "\ninterfaces:" + _DEPTH, 1)
    jog = "arm_jog: {type: forward_command, device: arm, active: false, client: servo, command_interfaces: [velocity]}"
    switch = "  switches: {to_jog: {activate: [arm_jog], deactivate: [arm_trajectory]}}\n"
    text = text.replace("    arm_speed:", f"    {jog}\n    arm_speed:", 1).replace(
        "\nmotion:\n", f"\n{switch}\nmotion:\n", 1
    )
    return text.replace("\nmotion:\n", f"\nmotion:{_SERVO}{_OCTOMAP}", 1)


@pytest.fixture(scope="module", params=["humble", "jazzy"])
def distro(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def texts(distro: str, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    return emitted(tmp_path_factory.mktemp(distro), _spec(distro))


def _parameters(texts: dict[str, str], file: str) -> dict[str, Any]:
    (parameters,) = (node["ros__parameters"] for node in safe_load(texts[f"config/moveit/{file}.yaml"]).values())
    return dict(parameters)


def test_the_updater_gets_every_parameter_without_which_it_does_not_start(texts: dict[str, str]) -> None:
    told = _parameters(texts, "sensors_3d")
    (sensor,) = told["sensors"]
    assert set(told[sensor]) == _OF_IMAGE
    assert told["octomap_resolution"] == 0.025
    # The depth sensor of a D435i sees from 0.1 m on (datasheet 337029 at 424x240), the cell looks 2 m far.
    assert told[sensor]["image_topic"] == "/camera/depth/image_rect_raw"
    assert told[sensor]["far_clipping_plane_distance"] == 2.0
    assert told[sensor]["near_clipping_plane_distance"] > 0.0
    needed = {exec_depend.text for exec_depend in ElementTree.fromstring(texts["package.xml"]).findall("exec_depend")}
    assert {"moveit_ros_perception", "moveit_servo"} <= needed


def test_servo_streams_velocities_to_its_own_controller(texts: dict[str, str], distro: str) -> None:
    told = _parameters(texts, "servo")["moveit_servo"]
    # servo.cpp of 2.12.4, validateParams: of an array positions or velocities, never both.
    assert (told["command_out_topic"], told["command_out_type"]) == ("/arm_jog/commands", "std_msgs/Float64MultiArray")
    assert (told["publish_joint_positions"], told["publish_joint_velocities"]) == (False, True)
    assert told["scale"] == {"linear": 0.05, "rotational": 0.2, "joint": 0.1}
    assert (told["publish_period"], told["move_group_name"]) == (0.004, "manipulator")
    # move_group says its scene there: capability_names.hpp and planning_scene_monitor.cpp.
    assert told["monitored_planning_scene_topic"] == "/monitored_planning_scene"
    assert told["is_primary_planning_scene_monitor"] is False
    assert ("ee_frame_name" in told) == (distro == "humble")


def test_servo_is_started_by_a_person_and_told_the_robot(texts: dict[str, str]) -> None:
    launch = ElementTree.fromstring(texts["launch/move.launch.xml"])
    (servo,) = (node for node in launch.findall("node") if node.get("name") == "servo")
    assert "bring_up" in servo.get("launch-prefix", "")
    given = [param.get("from", "").rpartition("/")[2] or param.get("name") for param in servo.findall("param")]
    assert {"robot_description", "robot_description_semantic", "kinematics.yaml", "servo.yaml"} <= set(given)
    assert not [node for node in ElementTree.fromstring(texts["launch/cell.launch.xml"]) if node.get("name") == "servo"]


def test_the_policy_lets_servo_command_that_controller_and_the_audit_that_the_mock_does_not(
    texts: dict[str, str],
) -> None:
    policy = policy_of(texts)
    (enclave,) = (enclave for enclave in policy.iter("enclave") if enclave.get("path", "").endswith("/servo"))
    published = {
        topic.text for topics in enclave.iter("topics") if topics.get("publish") for topic in topics.iter("topic")
    }
    assert "/arm_jog/commands" in {f"/{(name or '').lstrip('/')}" for name in published}
    proof = texts["audit.md"].split("\n## What the mock cannot prove\n")[1]
    assert "(MoveIt Servo): the mock does not execute it" in proof
    assert "the mock plans without it" in proof


def test_the_mock_still_detects_in_the_stream_that_perception_hears(texts: dict[str, str]) -> None:
    # Depth stands first among the interfaces, and nobody looks for the object in it.
    camera = contract_data(texts["contract.json"])["devices"]["camera"]["camera"]
    assert camera["topic"] == "/camera/color/image_raw"


def test_the_gate_has_the_service_that_starts_servo_and_its_figures(texts: dict[str, str], distro: str) -> None:
    # servo_node.cpp of 2.5.9, line 58; of 2.12.4, line 130.
    gate = texts["gates/promotion.md"].split("\n## G7 ")[1].replace("\\", "")
    starts = "/servo/start_servo" if distro == "humble" else "/servo/switch_command_type"
    assert f"Then call {starts} and activate `/arm_jog`." in gate
    assert "at no more than 50 mm/s, 0.2 rad/s and 0.1 rad/s per joint. It must stop within 0.1 s" in gate
