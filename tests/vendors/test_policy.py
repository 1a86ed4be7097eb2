"""The access policy against everything that each program has at the ROS graph: what is denied does not start."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import Any

import pytest

from tests.cells import DISTROS
from tests.consumers.matrix import PLANNING, SPECS, Build, build
from tests.consumers.permissions import Permissions, Right, permissions
from tests.consumers.starting import every_process, moves, node_name
from tests.foreign_yaml import safe_load
from tests.oracles import needs_upstream
from tests.vendors.oracle import VENDORS

pytestmark = needs_upstream

_IMPLIED = {"humble": "humble", "jazzy": "jazzy", "kilted": "kilted_lyrical", "lyrical": "kilted_lyrical"}
_CONTROL = {"humble": "2.54.0_humble", "jazzy": "4.46.0_jazzy", "kilted": "5.16.0_kilted", "lyrical": "6.8.0_lyrical"}
_MOVEIT = {"humble": "2.5.9_humble", "jazzy": "2.12.4_jazzy", "kilted": "2.14.1_kilted", "lyrical": "2.15.0_rolling"}
_RIGHTS: dict[str, Right] = {
    "publishers": "publish",
    "publishes": "publish",
    "subscriptions": "subscribe",
    "services": "reply",
    "services_served": "reply",
    "clients": "request",
    "action_servers": "execute",
    "actions_served": "execute",
}
every_build = pytest.mark.parametrize(("cell", "distro"), [(cell, distro) for cell in SPECS for distro in DISTROS])


@cache
def _facts(path: str) -> Any:
    return safe_load((VENDORS / path).read_text(encoding="utf-8"))


@cache
def _granted(cell: str, distro: str) -> dict[str, Permissions]:
    return permissions(build(cell, distro).texts)


def _ends(listed: Any, node: str) -> Iterator[tuple[Right, str]]:
    """Yield what the facts list of a node, by names in the cell; what is without a word is in its namespace."""
    home = node.rpartition("/")[0]
    for key, right in _RIGHTS.items():
        names = listed.get(key, {}) if isinstance(listed, dict) else {}
        for name in names if isinstance(names, dict) else ():
            full = name.replace("~", node, 1) if name.startswith("~") else name
            yield right, full if full.startswith("/") else f"{home}/{full}"


def _implied(distro: str, kind: str) -> Any:
    return _facts(f"implied/{_IMPLIED[distro]}.yaml")[kind]


def _enclaves(built: Build) -> dict[str, list[str]]:
    """Return the nodes of every enclave that a process of the launch files starts in."""
    found: dict[str, list[str]] = {}
    for process in (*every_process(built), *moves(built, "real")):
        first = f"spawner_{process.arguments[0]}" if process.executable == "spawner" else ""
        name = f"{process.namespace}/{first}" if first else node_name(process)
        found.setdefault(process.ros_arguments[1], []).append(name)
    return found


@every_build
def test_every_process_may_have_what_every_node_has(cell: str, distro: str) -> None:
    built = build(cell, distro)
    for enclave, nodes in _enclaves(built).items():
        for node in nodes:
            for right, name in _ends(_implied(distro, "rclcpp_node"), node):
                assert _granted(cell, distro)[enclave].allow(right, name), (enclave, right, name)


@every_build
def test_controller_managers_may_have_what_theirs_have(cell: str, distro: str) -> None:
    built = build(cell, distro)
    facts = _facts(f"ros2_control/{_CONTROL[distro]}/nodes.yaml")["nodes"]["controller_manager"]
    for process in (process for process in every_process(built) if process.executable == "ros2_control_node"):
        enclave = _granted(cell, distro)[process.ros_arguments[1]]
        for right, name in _ends(facts, node_name(process)):
            told = process.remaps["~/robot_description"] if name.endswith("/robot_description") else name
            assert enclave.allow(right, told), (right, name)
        # A controller says its transitions although it has no services of a life cycle.
        for own in (f"{process.namespace}/{controller}" for controller in _controllers(built, process.namespace)):
            for right, name in (
                *_ends(_implied(distro, "rclcpp_node"), own),
                ("publish", f"{own}/transition_event"),
                *((("reply", f"{own}/get_logger_levels"),) if distro != "humble" else ()),
            ):
                assert enclave.allow(right, name), (right, name)


def _controllers(built: Build, namespace: str) -> list[str]:
    spawned = [process.arguments for process in every_process(built) if process.executable == "spawner"]
    return [
        name
        for words in spawned
        for name in words[: words.index("-c")]
        if words[words.index("-c") + 1] == f"{namespace}/controller_manager"
    ]


_IN_PROCESS = "5581230944"  # an address in decimal, as move_group appends it


@pytest.mark.parametrize(("cell", "distro"), [(cell, distro) for cell in PLANNING for distro in DISTROS])
def test_move_group_may_have_what_all_nodes_of_its_process_have(cell: str, distro: str) -> None:
    built, facts = build(cell, distro), _facts(f"moveit/{_MOVEIT[distro]}/nodes.yaml")
    enclave = _granted(cell, distro)[f"/{cell}/move_group"]
    nodes = {
        "move_group": "/move_group",
        "move_group_private_<number>": f"/move_group_private_{_IN_PROCESS}",
        "moveit_simple_controller_manager": "/moveit_simple_controller_manager",
        "/move_group/moveit": "/move_group/moveit",
        "moveit_<random>": "/moveit_2857311",
    }
    assert any(process.executable == "move_group" for process in every_process(built))
    for key, node in nodes.items():
        for right, name in _ends(facts["nodes_in_the_process"].get(key), node):
            assert enclave.allow(right, name), (right, name)
        if key in facts["nodes_in_the_process"]:
            for right, name in _ends(_implied(distro, "rclcpp_node"), node):
                assert enclave.allow(right, name), (right, name)
    absent = set(facts["not_default_in_this_release"])
    started = {key: one for key, one in facts["default_capabilities"].items() if key not in absent}
    for listed in (*started.values(), facts["occupancy_map_monitor"], *_sequences(facts)):
        for right, name in _ends(listed, "/move_group"):
            assert enclave.allow(right, name), (right, name)
    for topic in ("/tf", "/tf_static"):
        assert enclave.allow("subscribe", topic)


def _sequences(facts: Any) -> list[Any]:
    return [one for key, one in facts["other_capabilities"].items() if "MoveGroupSequence" in key]


# What stands in place of a stream: the depth image is rectified, extrinsics are those to the depth stream.
_STREAMS = {"image_raw": "color", "image_rect_raw": "depth", "sample": "gyro", "imu_info": "accel"}


@pytest.mark.parametrize("distro", DISTROS)
def test_cameras_may_have_what_their_program_has(distro: str) -> None:
    enclave = _granted("ur5e_pick", distro)["/ur5e_pick/camera"]
    facts = _facts("realsense/4.58.3/nodes.yaml")["nodes"]["camera"]["endpoints"]
    told = {key: listed for key, listed in facts.items() if key != "services_safety_camera_only"}
    wanted: set[tuple[Right, str]] = set()
    for right, name in _ends(told, "/camera"):
        stream = _STREAMS.get(name.rpartition("/")[2], "color")
        full = re.sub("<base>_to_<stream>", "depth_to_color", name)
        full = re.sub("aligned_depth_to_<stream>", "aligned_depth_to_color", full)
        wanted.add((right, re.sub(r"<gyro\|accel>|<stream>", stream, full)))
    # Not a D435i's, or not without publish_tf, which no cell sets; transports are those that are installed.
    not_here = ("/tf", "/tf_static", "/camera/occupancy", "/camera/labeled_point_cloud/points")
    wanted = {(right, name) for right, name in wanted if name not in not_here and not name.startswith("/<")}
    assert len(wanted) > 15
    for right, name in wanted:
        assert enclave.allow(right, name), (right, name)
    assert enclave.allow("publish", "/camera/color/image_raw/compressed")


@pytest.mark.parametrize("distro", ["humble", "jazzy"])
def test_the_nodes_of_a_hardware_plugin_may_have_what_they_have(distro: str) -> None:
    facts = _facts(f"franka/{'humble-2.5.0' if distro == 'humble' else 'jazzy-3.4.0'}/nodes.yaml")
    enclave = _granted("fr3_hand", distro)["/fr3_hand/controller_manager"]
    for node in ("action_server", "service_server"):
        listed = [*_ends(facts[node], f"/{node}"), *_ends(_implied(distro, "rclcpp_node"), f"/{node}")]
        assert len(listed) > 9
        for right, name in listed:
            assert enclave.allow(right, name), (right, name)
    hand = _granted("fr3_hand", distro)["/fr3_hand/hand_gripper"]
    for right, name in _ends(facts["franka_gripper"], "/hand_gripper"):
        assert hand.allow(right, "/joint_states" if name.endswith("/joint_states") else name), (right, name)


@every_build
def test_nobody_may_ask_for_what_changes_a_camera_or_moves_past_the_controllers(cell: str, distro: str) -> None:
    for enclave in _granted(cell, distro).values():
        for service in ("hw_reset", "calib_config_write"):
            assert not enclave.allow("request", f"/camera/{service}")
        for action in ("/camera/triggered_calibration", "/action_server/ptp_motion", "/sequence_move_group"):
            assert not enclave.allow("call", action)
