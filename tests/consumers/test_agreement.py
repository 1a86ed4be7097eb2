"""What is written in several emitted files is the same in all of them, and is what the spec says."""

from __future__ import annotations

import hashlib
import json
import math
import re
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.etree.ElementTree import fromstring

import pytest

from cellc.mock.folder import read_folder
from tests.consumers.matrix import PLANNING, build, every_build, every_planning_build, spec_for
from tests.consumers.parameter_files import sections, told
from tests.consumers.refused_parameters import claimed, interfaces
from tests.consumers.starting import node_name, processes, written, written_managers
from tests.emit.cells import contract_data
from tests.foreign_yaml import safe_load

_RELIABILITY, _DURABILITY = {"reliable", "best_effort"}, {"volatile", "transient_local"}
_LEGAL = {
    "reliability": _RELIABILITY,
    "durability": _DURABILITY,
    "history": {"keep_last", "keep_all"},
    "liveliness": {"automatic", "manual_by_topic"},
}
# What the drivers declare: ur_control.launch.py, rs_launch.py, franka_gripper's gripper.launch.py.
_SENSORS = ("rgb_camera", "depth_module")
_OF_DRIVERS = {
    "dashboard_client": {"robot_ip"},
    "robot_state_helper": {"robot_ip", "headless_mode"},
    "franka_gripper_node": {"robot_ip", "joint_names"},
    "realsense2_camera_node": {
        *("camera_name", "base_frame_id", "tf_prefix", "publish_tf"),
        *(f"enable_{stream}" for stream in ("color", "depth", "infra1", "infra2", "gyro", "accel")),
        *("rgb_camera.color_profile", "depth_module.depth_profile", "pointcloud.enable", "align_depth.enable"),
        "wait_for_device_timeout",
        *(
            f"{sensor}.{name}"
            for sensor in ("rgb_camera", "depth_module")
            for name in ("exposure", "enable_auto_exposure")
        ),
    },
}


# Chapter 4, section 6: what is logged of every attempt.
_LOGGED = [
    *("attempt_id", "version_tuple", "calibration_id", "goal_frame", "goal_stamp", "joint_state_age", "tf_lookup_age"),
    *("plan_result", "controller_name", "action_goal_id", "speed_scaling", "safety_state", "fault_code"),
    *("cancel/result", "operator_intervention"),
]


def contract(cell: str, distro: str) -> Any:
    """Return the contract as plain data."""
    return contract_data(build(cell, distro).texts["contract.json"])


@every_build
def test_attempts_are_logged_with_what_the_chapter_asks_for(cell: str, distro: str) -> None:
    assert contract(cell, distro)["attempt_fields"] == _LOGGED


@every_build
def test_frames_are_where_the_description_has_them(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    frames, promised = safe_load(texts["config/frames.yaml"])["frames"], contract(cell, distro)["frames"]
    robot = fromstring(build(cell, distro).urdf("real"))
    above = {tag.attrib["link"]: joint for joint in robot.findall("joint") for tag in joint.findall("child")}
    assert set(frames) == set(promised)
    assert {link.attrib["name"] for link in robot.findall("link")} == {
        name for name, frame in frames.items() if frame["authority"] == "robot_state_publisher"
    }
    for name, frame in frames.items():
        assert (frame.get("parent", ""), frame["kind"]) == (promised[name]["parent"], promised[name]["kind"])
        assert frame["authority"] == promised[name]["authority"]
        if name in above:
            origin, parent = above[name].find("origin"), above[name].find("parent")
            assert parent is not None
            assert frame["parent"] == parent.attrib["link"]
            for key in ("xyz", "rpy"):
                stated = "0 0 0" if origin is None else origin.get(key, "0 0 0")
                assert frame[key] == pytest.approx([float(part) for part in stated.split()], abs=1e-9)
            assert promised[name]["pose"] is None, name  # its one truth is the description


@every_build
def test_contract_has_the_limits_of_the_description(cell: str, distro: str) -> None:
    robot = fromstring(build(cell, distro).urdf("real"))
    limits = {joint.attrib["name"]: joint.find("limit") for joint in robot.findall("joint")}
    for joint, promised in contract(cell, distro)["joint_limits"].items():
        limit = limits[joint]
        assert limit is not None
        for key, name in (("lower", "lower"), ("upper", "upper"), ("velocity", "velocity")):
            stated = limit.get(key)  # a continuous joint has no lower and upper
            assert promised.get(name) == (None if stated is None else pytest.approx(float(stated), abs=1e-12)), joint


@every_build
def test_contract_has_the_controllers_of_the_parameter_files(cell: str, distro: str) -> None:
    texts, promised = build(cell, distro).texts, contract(cell, distro)["managers"]
    loops = [process for process in processes(cell, distro, "mock") if process.executable == "ros2_control_node"]
    for process, manager in zip(loops, promised.values(), strict=True):
        values = told(texts, process.files, node_name(process))
        assert (values["update_rate"], process.namespace) == (manager["update_rate_hz"], manager["namespace"])
        types = {key.removesuffix(".type"): plugin for key, plugin in values.items() if key.endswith(".type")}
        own_names = {
            controller["full_name"].rpartition("/")[2]: controller for controller in manager["controllers"].values()
        }
        assert types == {name: one["plugin"] for name, one in own_names.items()}
        for name, one in own_names.items():
            own = told(texts, process.files, one["full_name"])
            joints = own.get("joints", [own["joint"]] if "joint" in own else [])
            assert joints == one["joints"] or one["behavior"] == "joint_state_broadcaster", name
            if "command_interfaces" in own:
                kinds = own["command_interfaces"]
                assert one["command_interfaces"] == [f"{joint}/{kind}" for joint in joints for kind in kinds]
            if joints and "state_interfaces" in own:
                kinds = own["state_interfaces"]
                assert one["state_interfaces"] == [f"{joint}/{kind}" for joint in joints for kind in kinds]


_UNITS = {"s": 1.0, "ms": 1e-3, "rad": 1.0, "mm": 1e-3, "m": 1.0, "deg": 0.017453292519943295}


def _quantities(text: str) -> list[tuple[float, bool]]:
    """Return each number in SI, and whether it is a length: a unit is that of all numbers since the last unit."""
    found: list[tuple[float, bool]] = []
    for numbers, unit in re.findall(r"((?:-?[\d.]+ )+)([a-z]+)", text):
        found += [(float(number) * _UNITS[unit], unit in ("m", "mm")) for number in numbers.split()]
    return found


def _si(text: str, *, length: bool = False) -> float:
    (number,) = [value for value, linear in _quantities(text) if linear is length]
    return number


@every_build
def test_tolerances_are_those_of_the_spec_for_every_joint(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    tags = fromstring(build(cell, distro).urdf("mock")).findall("joint")
    sliding = {tag.attrib["name"] for tag in tags if tag.get("type") == "prismatic"}
    loops = [process for process in processes(cell, distro, "mock") if process.executable == "ros2_control_node"]
    for process, (namespace, manager) in zip(loops, written_managers(cell, distro), strict=True):
        for name, one in manager["controllers"].items():
            own = told(texts, process.files, f"{namespace}/{name}")
            for joint in own.get("joints", ()) if "goal_time" in one else ():
                assert own[f"constraints.{joint}.trajectory"] == pytest.approx(
                    _si(one["path_tolerance"], length=joint in sliding)
                )
                assert own[f"constraints.{joint}.goal"] == pytest.approx(
                    _si(one["goal_tolerance"], length=joint in sliding)
                )
            if "goal_time" in one:
                assert own["constraints.goal_time"] == pytest.approx(_si(one["goal_time"]))
                assert own["constraints.stopped_velocity_tolerance"] > 0
                assert own["allow_partial_joints_goal"] is own["allow_nonzero_velocity_at_trajectory_end"] is False


@every_build
def test_qos_overrides_are_those_of_the_contract(cell: str, distro: str) -> None:
    text = build(cell, distro).texts.get("config/nodes.yaml")
    if text is None:
        return
    interfaces = contract(cell, distro)["interfaces"]
    for key, values in sections(text).items():
        stated: dict[tuple[str, str], dict[str, Any]] = {}
        for name, value in values.items():
            if not name.startswith("qos_overrides."):
                continue
            topic, side, policy = name.removeprefix("qos_overrides.").rsplit(".", 2)
            assert policy == "depth" or value in _LEGAL[policy], name
            stated.setdefault((topic, side), {})[policy] = value
        for (topic, side), policies in stated.items():
            ends = interfaces[topic]["sources" if side == "publisher" else "sinks"]
            (qos,) = [end["qos"] for end in ends if f"/{end['node']}" == key]
            assert policies == {name: qos[name] for name in (*_LEGAL, "depth")}


@every_build
def test_recording_has_a_complete_profile_for_each_topic_that_it_records(cell: str, distro: str) -> None:
    text = build(cell, distro).texts["config/recording_qos.yaml"]
    profiles = safe_load(text)
    commanded = [line.strip("# \\") for line in text.splitlines() if re.match(r"#   /", line)]
    assert commanded == list(profiles)
    for topic, profile in profiles.items():
        assert set(profile) == {"history", "depth", "reliability", "durability"}, topic
        assert all(profile[name] in _LEGAL[name] for name in ("history", "reliability", "durability"))
        interface = contract(cell, distro)["interfaces"].get(topic)
        if interface is None:
            # qos.md 2: rcl_action's status is latched with the last one, its feedback and any other topic keeps ten.
            # /rosout keeps a thousand (rcl, logging_rosout.h); a manager of at most 1 kHz has a second of states.
            keeps = 1000 if topic == "/rosout" or topic.endswith(("/controller_state", "/statistics/values")) else 10
            assert profile["depth"] == (1 if topic.endswith(("/_action/status", "/statistics/names")) else keeps)
            continue
        # One queue for all publishers (rosbag2 pull request 1960), a second of samples, and never less than tf2's own.
        offered = sum(end["qos"]["depth"] for end in interface["sources"])
        assert profile["depth"] == max(100, offered, math.ceil(interface["rate_hz"] or 0))


@every_build
def test_cycles_of_managers_are_recorded_where_the_release_publishes_them(cell: str, distro: str) -> None:
    """ros2_control@4.46.0 controller_manager/src/controller_manager.cpp:639,684; 2.54.0 (Humble) publishes none."""
    profiles = safe_load(build(cell, distro).texts["config/recording_qos.yaml"])
    cycles = {topic: profile["durability"] for topic, profile in profiles.items() if "/statistics/" in topic}
    observed = json.loads(build(cell, distro).texts["config/observe.json"])
    managers = set(observed["real"]["states"])
    expected = {} if distro == "humble" else {f"{node}/statistics/names": "transient_local" for node in managers}
    assert cycles == expected | {name.replace("/names", "/values"): "volatile" for name in expected}


@every_build
def test_drivers_are_told_what_they_declare_and_the_address_of_the_spec(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    addresses = {
        device["connection"].get("address") for device in written(cell)["devices"].values() if "connection" in device
    }
    for process in processes(cell, distro, "real"):
        if process.executable in _OF_DRIVERS:
            values = told(texts, process.files, node_name(process))
            assert set(values) == _OF_DRIVERS[process.executable], node_name(process)
            joints = [tag.attrib["name"] for tag in fromstring(build(cell, distro).urdf("real")).findall("joint")]
            moved = values.get("joint_names")
            assert moved is None or (len(moved) == 2 and set(moved) <= set(joints))  # two fingers
            switches = [name for name in values if re.search(r"enable|headless|publish_tf", name)]
            assert all(isinstance(values[name], bool) for name in switches)
            assert values.get("robot_ip") in addresses | {None, "UNKNOWN"}  # UNKNOWN blocks the real target
            rates = [
                str(interface["rate_hz"])
                for interface in contract(cell, distro)["interfaces"].values()
                if interface["rate_hz"]
            ]
            profiles = [value.split(",")[2] for name, value in values.items() if name.endswith("_profile")]
            assert {f"{rate}.0" for rate in profiles} <= set(rates)


@every_build
def test_manifest_names_every_file(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    files = json.loads(texts["manifest.json"])["files"]
    assert set(files) == set(texts) - {"manifest.json"}
    assert all(re.fullmatch("[0-9a-f]{64}", digest) for digest in files.values())


@every_build
def test_manifest_has_the_digest_of_every_file(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    for path, digest in json.loads(texts["manifest.json"])["files"].items():
        assert hashlib.sha256(texts[path].encode()).hexdigest() == digest, path


# spec.md, what `cellc build` writes; the middleware's profile depends on the middleware.
_PARTS = {
    *("README.md", "audit.md", "CMakeLists.txt", "package.xml", "contract.json", "rehearsals.json", "manifest.json"),
    *(f"config/{name}.yaml" for name in ("frames", "recording_qos")),
    *("gates/promotion.md", "gates/network.md", "graph/nodes.svg", "graph/responsibility.svg"),
    *("launch/cell.launch.xml", "security/policy.xml", "security/common.xml"),
}


_FOR_PLANNING = {
    "config/joint_limits.yaml",
    *(f"config/moveit/{name}.yaml" for name in ("kinematics", "move_group")),
}


def _planned_at_a_driver(texts: dict[str, str], cell: str, distro: str) -> bool:
    """Tell whether move_group commands a controller whose goals a driver's own node takes on real hardware."""
    devices = contract_data(texts["contract.json"])["devices"]
    controllers = (
        controller for _, manager in written_managers(cell, distro) for controller in manager["controllers"].values()
    )
    planned = {controller.get("device") for controller in controllers if controller.get("client") == "move_group"}
    return any(device["driver"] and name in planned for name, device in devices.items())


def _planned_on_the_mock_alone(cell: str, distro: str) -> bool:
    """Tell whether move_group commands a controller that claims what no component has on real hardware."""
    texts, offered = build(cell, distro).texts, interfaces(build(cell, distro).urdf("real"))
    loops = [process for process in processes(cell, distro, "mock") if process.executable == "ros2_control_node"]
    return any(
        one.get("client") == "move_group"
        and not set(claimed(told(texts, process.files, f"{namespace}/{name}"))) <= offered
        for process, (namespace, manager) in zip(loops, written_managers(cell, distro), strict=True)
        for name, one in manager["controllers"].items()
    )


@every_build
def test_package_has_every_part(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    descriptions = {f"urdf/{cell}.mock.urdf", f"urdf/{cell}.real.urdf", f"config/moveit/{cell}.srdf"}
    assert _PARTS | descriptions <= set(texts)
    spec = safe_load(spec_for(cell, distro))
    # One file of controllers, unless a driver's own node takes goals on real hardware, or nothing moves a joint there.
    apart = _planned_at_a_driver(texts, cell, distro) or _planned_on_the_mock_alone(cell, distro)
    called = ("controllers.mock", "controllers.real") if apart else ("controllers",)
    planning = _FOR_PLANNING | {f"config/moveit/{name}.yaml" for name in called}
    assert planning & set(texts) == (planning if cell in PLANNING else set())  # nobody reads them where no node plans
    assert {f"middleware/{host}.sh" for host in spec.get("hosts", {})} <= set(texts)
    overridden = any(
        "to" in interface or isinstance(interface.get("from"), dict)
        for interface in spec.get("interfaces", {}).values()
    )
    assert ("qos_overrides:" in texts.get("config/nodes.yaml", "")) is overridden


@every_build
def test_targets_differ_in_their_hardware_alone(cell: str, distro: str) -> None:
    robots = [fromstring(build(cell, distro).urdf(target)) for target in ("mock", "real")]
    for robot in robots:
        for tag in robot.findall("ros2_control"):
            robot.remove(tag)
    # Comments are gone; what stood between the tags is not compared.
    parts = [[(tag.tag, tag.attrib, (tag.text or "").strip()) for tag in robot.iter()] for robot in robots]
    assert parts[0] == parts[1]


@every_build
def test_contract_has_limits_calibrations_and_pairs_of_the_other_files(cell: str, distro: str) -> None:
    texts, promised = build(cell, distro).texts, contract(cell, distro)
    limits = sections(texts["config/joint_limits.yaml"])["/**"] if "config/joint_limits.yaml" in texts else {}
    for joint, limit in promised["joint_limits"].items() if limits else ():
        for name in ("acceleration", "jerk"):
            assert limits[f"robot_description_planning.joint_limits.{joint}.max_{name}"] == limit[name], joint
    frames = safe_load(texts["config/frames.yaml"])["frames"]
    assert {name: frame.get("calibration") for name, frame in frames.items()} == {
        name: frame["calibration"] for name, frame in promised["frames"].items()
    }
    publishers = json.loads(texts["manifest.json"])["configuration_inputs"]["tf_publishers"]
    assert {name: frame["authority"] for name, frame in frames.items() if name in publishers} == publishers
    links = {tag.attrib["link"] for tag in fromstring(build(cell, distro).urdf("real")).iter("child")}
    assert links - set(publishers) == set()


@every_build
def test_clocks_and_draws_name_what_the_contract_has(cell: str, distro: str) -> None:
    texts, promised = build(cell, distro).texts, contract(cell, distro)
    assert set(promised["clock_of"].values()) - set(promised["clocks"]) == set()
    drawn = json.loads(texts.get("config/uncertainty.json", '{"quantities": [], "tolerances": {}, "expected": {}}'))
    known = {"clock": promised["clocks"], **dict.fromkeys(("calibration", "place", "region"), promised["frames"])}
    known |= {kind: set(promised["devices"]) for kind in ("part", "compensation")}
    known["repeatability"] = {group["tip_frame"] for group in promised["groups"].values()}
    for quantity in drawn["quantities"]:
        assert quantity["target"] in known[quantity["kind"]], quantity
        spec: Any = written(cell)
        for key in quantity["source"].split("."):
            assert key in spec, quantity
            spec = spec[key]
    assert set(drawn["tolerances"]) <= set(promised["goals"])
    rehearsed = {rehearsal["name"] for rehearsal in json.loads(texts["rehearsals.json"])["rehearsals"]}
    assert set(drawn["expected"]) <= rehearsed


@every_planning_build
def test_named_states_are_the_poses_of_the_spec(cell: str, distro: str) -> None:
    semantic = fromstring(build(cell, distro).texts[f"config/moveit/{cell}.srdf"])
    states = {
        (group_state.attrib["name"], group_state.attrib["group"]): group_state
        for group_state in semantic.findall("group_state")
    }
    for pose, groups in written(cell)["motion"].get("poses", {}).items():
        for group, text in groups.items():
            values = [float(joint.attrib["value"]) for joint in states[pose, group].findall("joint")]
            assert values == pytest.approx([value for value, _ in _quantities(text)], abs=1e-12)


@every_build
def test_mock_reads_the_collision_pairs_of_the_semantic_description(cell: str, distro: str) -> None:
    semantic = fromstring(build(cell, distro).texts[f"config/moveit/{cell}.srdf"])
    pairs = [
        (disable_collisions.attrib["link1"], disable_collisions.attrib["link2"])
        for disable_collisions in semantic.findall("disable_collisions")
    ]
    links = {link.attrib["name"] for link in fromstring(build(cell, distro).urdf("mock")).findall("link")}
    assert {name for pair in pairs for name in pair} <= links
    assert len({frozenset(pair) for pair in pairs}) == len(pairs) > 10
    with TemporaryDirectory() as folder:
        for path, text in build(cell, distro).texts.items():
            (Path(folder) / path).parent.mkdir(parents=True, exist_ok=True)
            (Path(folder) / path).write_text(text, encoding="utf-8")
        assert read_folder(Path(folder), edited=True).allowed_collisions == tuple(pairs)


@every_build
def test_steps_of_rehearsals_name_what_the_contract_has(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    promised = contract_data(texts["contract.json"])
    known = {
        "move": {*promised["poses"], *promised["goals"]},
        "detect": set(promised["frames"]),
        "grip": set(promised["devices"]),
        "set": set(promised["devices"]),
        "sense": set(promised["devices"]),
        "call": set(promised["interfaces"]),
        "acknowledge": {promised["safety"]["acknowledge"]},
    }
    for rehearsal in json.loads(texts["rehearsals.json"])["rehearsals"]:
        for step in rehearsal["steps"]:
            assert step["target"] in known.get(step["kind"], {""}), (rehearsal["name"], step)


@every_build
def test_what_a_person_states_is_asked_for_by_a_gate(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    pages = " ".join(text for path, text in texts.items() if path.endswith(".md"))
    launched = [fromstring(text) for path, text in texts.items() if path.startswith("launch/")]
    stated = {choice.attrib["value"] for root in launched for choice in root.iter("choice")}
    assert {one for one in stated if re.search(rf":={re.escape(one)}\b", pages) is None and "_" in one} == set()
