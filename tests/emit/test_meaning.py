"""What artifacts say of the complete cell, read by parsers that are not ours, against values written by hand.

``meaning.yaml`` has them by file. Of JSON and YAML it has a part: a mapping there is within the one that is read, and
everything else is equal. Nothing rewrites it.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from tests.cells import CORPUS, graph_of
from tests.consumers.permissions import policy_of
from tests.emit.cells import emitted_graph
from tests.foreign_yaml import safe_load

MEANT: dict[str, dict[str, Any]] = safe_load((Path(__file__).parent / "meaning.yaml").read_text(encoding="utf-8"))
FILES = [(spec, file) for spec, files in MEANT.items() for file in files]


@cache
def _artifacts(spec: str) -> dict[str, str]:
    return emitted_graph(graph_of(CORPUS / "valid" / f"{spec}.yaml"))


def _xml(spec: str, file: str) -> ElementTree.Element:
    return ElementTree.fromstring(_artifacts(spec)[file])


@pytest.mark.parametrize(("spec", "file"), FILES)
def test_file_says_what_the_spec_means(spec: str, file: str) -> None:
    text = _artifacts(spec)[file]
    read = json.loads(text) if file.endswith(".json") else safe_load(text)
    assert _missing(MEANT[spec][file], read) == []


def _missing(meant: Any, read: Any, path: str = "") -> list[str]:
    """Return where a part is not what was meant."""
    if isinstance(meant, dict) and isinstance(read, dict):
        return [said for key, value in meant.items() for said in _missing(value, read.get(key), f"{path}/{key}")]
    return [] if meant == read and type(meant) is type(read) else [f"{path}: expected {meant!r}, got {read!r}"]


def test_part_that_is_missing_or_of_another_type_is_told() -> None:
    read = {"a": {"b": 1, "c": 2}}
    assert _missing({"a": {"b": 1}}, read) == []
    assert _missing({"a": {"b": 1.0, "d": 3}}, read) == ["/a/b: expected 1.0, got 1", "/a/d: expected 3, got None"]


@pytest.mark.parametrize("target", ["mock", "real"])
def test_description_has_each_mount_and_the_hardware_of_its_target(target: str) -> None:
    robot = _xml("complete", f"urdf/demo.{target}.urdf")
    mounts = {}
    for joint in robot.iterfind("joint"):
        (origin, parent, child) = (joint.find(tag) for tag in ("origin", "parent", "child"))
        assert parent is not None
        assert child is not None
        placed = {} if origin is None else origin.attrib
        mounts[child.get("link")] = (parent.get("link"), placed.get("xyz"), placed.get("rpy"))
    # devices: 0 0 0.8 m; 0 -70 30 mm turned by 0 -75 -90 deg. frames: 0 0 162 mm; 450 100 850 mm.
    assert mounts["arm_base_link"] == ("world", "0 0 0.8", None)
    assert mounts["tcp"] == ("gripper_base", "0 0 0.162", None)
    assert mounts["fixture_A"] == ("world", "0.45 0.1 0.85", None)
    camera = mounts["camera_link"]
    assert camera[:2] == ("arm_tool0", "0 -0.07 0.03")
    assert [round(float(part), 9) for part in str(camera[2]).split()] == [0.0, -1.308996939, -1.570796327]
    assert "object" not in mounts  # perception publishes it
    plugins = {
        ros2_control.get("name"): ros2_control.findtext("hardware/plugin")
        for ros2_control in robot.iterfind("ros2_control")
    }
    mocked = target == "mock"
    assert plugins["arm_hardware"] == ("mock_components/GenericSystem" if mocked else "demo_arm_driver/DemoArm")
    parameters = {
        param.get("name"): param.text for param in robot.iterfind("ros2_control[@name='arm_hardware']/hardware/param")
    }
    assert parameters == ({} if mocked else {"robot_ip": "192.168.56.101"})


def test_mock_begins_in_the_first_pose_of_the_rehearsals() -> None:
    robot = _xml("complete", "urdf/demo.mock.urdf")
    begin = {
        joint.get("name"): joint.findtext("state_interface[@name='position']/param[@name='initial_value']")
        for joint in robot.iterfind("ros2_control[@name='arm_hardware']/joint")
    }
    degrees = (0, -90, 90, -90, -90, 0)
    assert [round(float(text or "nan") * 180 / 3.141592653589793, 6) for text in begin.values()] == list(degrees)
    assert [*begin] == [f"arm_joint_{number}" for number in range(1, 7)]


def test_semantics_name_groups_states_and_the_tool() -> None:
    robot = _xml("complete", "config/moveit/demo.srdf")
    chain = robot.find("group[@name='manipulator']/chain")
    assert chain is not None
    assert chain.attrib == {"base_link": "arm_base_link", "tip_link": "tcp"}
    states = {
        (state.get("group"), state.get("name")): {joint.get("name"): joint.get("value") for joint in state}
        for state in robot.iterfind("group_state")
    }
    assert states["gripper", "open"] == {"gripper_finger_joint": "0"}
    assert states["gripper", "closed"] == {"gripper_finger_joint": "0.04"}
    assert set(states) == {("manipulator", "home"), ("gripper", "open"), ("gripper", "closed")}
    (tool,) = robot.iterfind("end_effector")
    assert tool.attrib == {"name": "gripper", "group": "gripper", "parent_link": "arm_tool0"}
    pairs = {
        (pair.get("link1"), pair.get("link2")): pair.get("reason") for pair in robot.iterfind("disable_collisions")
    }
    # The base and the tool have no shape that could touch anything.
    neighbors = {(f"arm_link_{number}", f"arm_link_{number + 1}") for number in range(1, 6)}
    assert {pair for pair, reason in pairs.items() if reason == "Adjacent"} == neighbors


def test_launch_starts_each_process_once_and_real_hardware_behind_its_gate() -> None:
    launch = _xml("complete", "launch/cell.launch.xml")
    started = [
        (node.get("pkg"), node.get("exec"), node.get("if"), node.get("unless")) for node in launch.iterfind("node")
    ]
    real = "$(eval \"'$(var target)' == 'real'\")"
    assert started == [
        ("robot_state_publisher", "robot_state_publisher", None, None),
        ("controller_manager", "ros2_control_node", None, None),
        ("cell_perception", "detector", None, None),
        ("moveit_ros_move_group", "move_group", None, None),
        ("controller_manager", "spawner", None, None),
        ("demo", "bring_up", real.replace("real", "mock"), None),
        ("demo", "bring_up", real, None),
    ]
    first, gate = (arg for arg in launch.iterfind("arg") if arg.get("if"))
    assert (first.get("name"), first.get("default"), first.get("if")) == ("stage", "10", real)
    assert (gate.get("name"), gate.get("default"), gate.get("if")) == ("confirm_real", None, real)
    assert [choice.get("value") for choice in gate] == ["I_HAVE_PASSED_GATES_G0_TO_G2"]
    defaults = {arg.get("name"): arg.get("default") for arg in launch.iterfind("arg") if arg.get("if") is None}
    assert defaults == {"target": "mock", "confirm_real": "no", "stage": "100", "arm_address": "192.168.56.101"}
    (mover,) = _xml("complete", "launch/move.launch.xml").iterfind("node")
    assert (mover.get("pkg"), mover.get("name")) == ("cell_tasks", "task")
    spawner = launch.find("node[@exec='spawner']")
    assert spawner is not None
    assert spawner.get("args") == "joint_states arm_trajectory gripper_action -c /controller_manager --inactive"


def test_first_goal_is_small_and_slow_and_alone() -> None:
    # bringup.first_motion: joint_6 within 5 deg, so 2.5 deg = 0.0436332 rad to either side, at 5 deg/s within 5 s: half
    # of the time, since a cubic spline takes 1.5 * 2.5 / 5 = 0.75 s at least. Limits of demo_arm: 2 pi.
    launch = _xml("complete", "launch/goal.launch.xml")
    (node,) = launch.iterfind("node")
    words = str(node.get("args")).split()
    values = dict(word.split("=") for word in words if "=" in word)
    assert round(float(values["--by"]), 7) == 0.0436332
    assert (values["--seconds"], values["--timeout"], values["--absent"]) == ("2.5", "5.0", "/task")
    assert [word.split(":")[0] for word in words[-6:]] == [f"arm_joint_{number}" for number in range(1, 7)]
    joints = [choice.get("value") for choice in launch.findall("arg[@name='joint']/choice")]
    assert joints == [f"arm_joint_{number}" for number in range(6, 0, -1)]  # the stated one, then from tip to base


def test_policy_gives_a_task_its_ends_and_nothing_else() -> None:
    (task,) = (
        enclave for enclave in policy_of(_artifacts("complete")).iter("enclave") if enclave.get("path") == "/demo/task"
    )
    rights: dict[tuple[str, str], set[str]] = {}
    for group in task.iterfind("profiles/profile/*"):
        for right in group.attrib:
            named = {str(one.text) for one in group if not str(one.text).startswith("~")}
            rights[group.tag, right] = rights.get((group.tag, right), set()) | named
    # Services below its own name are not listed here.
    rights = {key: names for key, names in rights.items() if names}
    assert rights == {
        ("topics", "publish"): {"/parameter_events", "/rosout"},
        ("topics", "subscribe"): {"/clock", "/parameter_events", "/joint_states", "/object_pose", "/tf", "/tf_static"},
        ("services", "reply"): {"tf2_frames"},
        ("actions", "call"): {"/gripper_action/gripper_cmd", "/move_action"},
    }


def test_package_depends_on_what_is_started_in_the_versions_of_the_spec() -> None:
    depends = {
        exec_depend.text: exec_depend.get("version_gte")
        for exec_depend in _xml("complete", "package.xml").iterfind("exec_depend")
    }
    versions = {"controller_manager": "4.47.0", "demo_arm_driver": "3.8.0", "moveit_ros_move_group": "2.12.4"}
    assert {name: depends[name] for name in versions} == versions
    assert {"cell_perception", "cell_tasks", "demo_arm_controllers", "robot_state_publisher"} <= depends.keys()
