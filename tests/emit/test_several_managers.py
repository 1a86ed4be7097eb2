"""Two arms, each with a controller manager in a namespace of its own."""

from __future__ import annotations

import json
import shlex
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

from tests.consumers.permissions import policy_of
from tests.emit.cells import contract_data, emitted, unbroken
from tests.foreign_yaml import safe_load

SPEC = """
format: 1
cell: two_arms
versions: {ros: jazzy}
devices:
  left: {model: ur5e, mount: {parent: world, xyz: 0 500 0 mm}}
  right: {model: ur5e, mount: {parent: world, xyz: 0 -500 0 mm}}
managers:
  left_loop:
    update_rate: 500 Hz
    namespace: /left
    controllers:
      joint_states: {type: joint_state_broadcaster, device: left}
      trajectory: {type: scaled_joint_trajectory, device: left, goal_time: 1 s}
  right_loop:
    update_rate: 500 Hz
    namespace: /right
    controllers:
      joint_states: {type: joint_state_broadcaster, device: right}
      trajectory: {type: scaled_joint_trajectory, device: right, goal_time: 1 s}
"""


@lru_cache(maxsize=1)
def _artifacts() -> dict[str, str]:
    with TemporaryDirectory() as folder:
        return emitted(Path(folder), SPEC)


def _nodes(executable: str) -> list[ElementTree.Element]:
    launch = ElementTree.fromstring(_artifacts()["launch/cell.launch.xml"])
    return [node for node in launch.findall("node") if node.get("exec") == executable]


def test_each_manager_reads_of_its_own_hardware_alone() -> None:
    for manager, hardware in (("left_loop", "left_hardware"), ("right_loop", "right_hardware")):
        robot = ElementTree.fromstring(_artifacts()[f"urdf/two_arms.{manager}.real.urdf"])
        assert [tag.get("name") for tag in robot.findall("ros2_control")] == [hardware]
        whole = ElementTree.fromstring(_artifacts()["urdf/two_arms.real.urdf"])
        assert len(robot.findall("link")) == len(whole.findall("link"))


def test_manager_reads_of_the_robots_that_its_own_can_meet(tmp_path: Path) -> None:
    # 8 m apart no link of one arm comes near the other; 1 m apart (above) each file has both.
    files = emitted(tmp_path, SPEC.replace("0 -500 0 mm", "0 -7.5 0 m"))
    for target in ("mock", "real"):
        for manager, arm in (("left_loop", "left"), ("right_loop", "right")):
            robot = ElementTree.fromstring(files[f"urdf/two_arms.{manager}.{target}.urdf"])
            links = [link.attrib["name"] for link in robot.findall("link")]
            assert {name.partition("_")[0] for name in links} == {"world", arm}
            whole = ElementTree.fromstring(files[f"urdf/two_arms.{target}.urdf"])
            own = [link for link in whole.findall("link") if link.attrib["name"].startswith(f"{arm}_")]
            assert len(links) == len(own) + 1


def test_each_manager_takes_its_description_from_its_own_topic() -> None:
    for manager, namespace in zip(_nodes("ros2_control_node"), ("/left", "/right"), strict=True):
        remaps = {remap.get("from"): remap.get("to") for remap in manager.findall("remap")}
        topic = f"{namespace}/robot_description"
        assert remaps == {"~/robot_description": topic, "robot_description": topic}


def test_spawners_hand_controllers_the_topic_where_joint_states_meet() -> None:
    # ros2_control 4.46.0: a manager that is told so itself warns with every controller that this is deprecated.
    for spawner, namespace in zip(_nodes("spawner"), ("/left", "/right"), strict=True):
        words = shlex.split(spawner.attrib["args"])
        assert words[-2:] == ["--controller-ros-args", f"--remap {namespace}/joint_states:=/joint_states"]


def test_static_frames_keep_one_authority() -> None:
    publishers = {node.get("name"): node for node in _nodes("robot_state_publisher")}
    said = [remap.get("from") for remap in publishers["robot_state_publisher"].findall("remap")]
    assert "/tf" not in said
    others = [node for node in _nodes("robot_state_publisher") if node.get("name") == "description_publisher"]
    assert [node.get("namespace") for node in others] == ["/left", "/right"]
    for node in others:
        assert {"/tf", "/tf_static"} <= {remap.get("from") for remap in node.findall("remap")}


def test_joint_states_of_both_meet_on_one_topic_without_a_merger() -> None:
    # joint_state_publisher would give old states a new stamp, and zero to joints that it has not heard of.
    assert not _nodes("joint_state_publisher")
    assert "joint_state_publisher" not in _artifacts()["package.xml"]
    interfaces = contract_data(_artifacts()["contract.json"])["interfaces"]
    ends = {name: [end["full_name"] for end in interfaces[name]["sources"]] for name in interfaces}
    assert ends["/joint_states"] == ["/left/joint_states", "/right/joint_states"]
    assert "/left/joint_states" not in interfaces


def test_descriptions_are_of_each_manager() -> None:
    interfaces = contract_data(_artifacts()["contract.json"])["interfaces"]
    for side in ("left", "right"):
        said = interfaces[f"/{side}/robot_description"]
        assert [end["full_name"] for end in said["sources"]] == [f"/{side}/description_publisher"]
        assert [end["full_name"] for end in said["sinks"]] == [f"/{side}/controller_manager"]
    assert interfaces["/robot_description"]["sinks"] == []


def test_namesakes_have_rights_on_their_own_interfaces_alone() -> None:
    policy = policy_of(_artifacts())
    executed = {
        (profile.get("ns"), action.text)
        for profile in policy.iter("profile")
        if profile.get("node") == "trajectory"
        for action in profile.iter("action")
    }
    assert executed == {(f"/{side}", f"/{side}/trajectory/follow_joint_trajectory") for side in ("left", "right")}


def test_every_parameter_key_carries_its_namespace() -> None:
    sections = safe_load(_artifacts()["config/left_loop.controllers.yaml"])
    assert all(key.startswith("/left/") for key in sections)
    joints = sections["/left/trajectory"]["ros__parameters"]["joints"]
    assert len(joints) == 6
    assert all(joint.startswith("left_") for joint in joints)


def test_network_gate_looks_at_each_description_and_knows_that_sources_add_up() -> None:
    gates = unbroken(_artifacts()["gates/network.md"])
    for side in ("left", "right"):
        asked = f"ros2 service call /{side}/description_publisher/get_parameters rcl_interfaces/srv/GetParameters"
        assert f'{asked} "names: [robot_description]" | grep -o "plugin.[[:alnum:]_]*/[[:alnum:]_:]*"' in gates
    # The slower manager publishes at 500 Hz; what is observed is the sum of both, and may not be less.
    assert json.loads(_artifacts()["contract.json"])["interfaces"]["/joint_states"]["rate_hz"] == 500.0
