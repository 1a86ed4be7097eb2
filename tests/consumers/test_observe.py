"""The program that compares the running graph with the package: what it calls right, and what it names as wrong."""

from __future__ import annotations

import ast
import json
import math
import os
import platform
import re
import sys
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from cellc.compiler.catalog.load import device_names, load_device
from cellc.compiler.emit.launch import observe_listener, observe_program
from cellc.compiler.emit.launch.observe_checks import (
    FAILED,
    PASSED,
    SEEN,
    UNKNOWN,
    Cycles,
    End,
    Line,
    Package,
    Reading,
    Seen,
    Stream,
    quaternion,
)
from cellc.compiler.emit.launch.observe_reports import comparisons, space
from tests.cells import EVERY_CELL, built
from tests.consumers.matrix import build, every_build
from tests.consumers.permissions import permissions, policy_of
from tests.emit.cells import contract_data

_FOR_S = 10.0


def package_of(cell: str, target: str, folder: Path, texts: Mapping[str, str] | None = None) -> Package:
    """Return a package as the program reads it."""
    for path, text in (built(cell).texts if texts is None else texts).items():
        if path.startswith(("config", "urdf")) or path == "contract.json":
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
    return observe_program.read_package(folder, target)


def right(package: Package, gate: str) -> Seen:
    """Return the graph that the files of a package describe."""
    seen = Seen(listened_s=_FOR_S)
    since = started_in(package)
    seen.nodes = [name for name in package.plan["nodes"] if "*" not in name and since.get(name, "") <= gate]
    for name, sides in package.plan["ends"].items():
        interface = package.contract["interfaces"][name]
        seen.ends[name] = (ends(interface, "sources", sides, gate), ends(interface, "sinks", sides, gate))
        rate = interface.get("rate_hz")
        if rate is not None and any(since <= gate for since in sides["sources"].values()):
            stream = seen.streams.setdefault(name, Stream())
            for number in range(int(rate * _FOR_S)):
                stream.take(100.0 + number / rate, (100.0 + number / rate, interface.get("frame") or ""))
            if interface["type"] == "sensor_msgs/msg/JointState":
                shown = [(name, place) for name, place in positions(package) if name not in unshown(package, gate)]
                stream.take_joints([name for name, _ in shown], [place for _, place in shown])
    described(package, seen, unshown(package, gate))
    answered(package, seen, gate)
    told(package, seen, gate)
    return seen


def started_in(package: Package) -> dict[str, str]:
    """Return the gate in which each node is started; it has no end before."""
    since: dict[str, str] = {}
    for sides in package.plan["ends"].values():
        for node, start in (*sides["sources"].items(), *sides["sinks"].items()):
            since[node] = min(start, since.get(node, start))
    return since


def told(package: Package, seen: Seen, gate: str) -> None:
    """Hear what managers and devices say of themselves: cycles of half their period, and what a gate expects."""
    for manager in package.contract["managers"].values():
        rate, node = manager["update_rate_hz"], f"{manager['namespace'].rstrip('/')}/controller_manager"
        figures = {"update_rate": str(rate), "periodicity.average": f"{rate:f}", "periodicity.min": f"{rate * 0.9:f}"}
        cycles = seen.cycles.setdefault(node, Cycles())
        cycles.statuses.append((0, "Controller Manager is running", figures))
        cycles.times_us.extend([0.5e6 / rate] * 1000)
    for node in seen.nodes:
        seen.answers[f"{node}/use_sim_time"] = SimpleNamespace(values=[SimpleNamespace(type=1, bool_value=False)])
    for reading in package.plan["readings"]:
        due = [names for since, names in sorted(reading.get("expected", {}).items()) if since <= gate]
        value: object = reading["values"][due[-1][0]] if due else 0.5
        if "version" in reading:
            value = package.contract["version_tuple"][reading["version"]].rpartition(" ")[2]
        seen.readings[reading["interface"]] = Reading([value])


def emitted_program(texts: Mapping[str, str]) -> tuple[Any, Any]:
    """Return the program and its comparisons as modules, made of the texts of a package."""
    files = [f"observe_{part}.py" for part in ("checks", "reports", "listener")]
    files += ["installed_versions.py", "observe_host.py", "observe"]
    modules = [ModuleType(file.partition(".")[0]) for file in files]
    with pytest.MonkeyPatch.context() as patch:
        for module, file in zip(modules, files, strict=True):
            patch.setitem(sys.modules, module.__name__, module)
            exec(compile(texts[f"scripts/{file}"], file, "exec"), module.__dict__)
    return modules[-1], modules[1]


def test_the_emitted_program_passes_its_package_and_names_a_second_commander(tmp_path: Path) -> None:
    program, checks = emitted_program(build("ur5e_pick", "jazzy").texts)
    package_of("ur5e_pick", "real", tmp_path, build("ur5e_pick", "jazzy").texts)
    for target in ("mock", "real"):
        package = program.read_package(tmp_path, target)
        seen = right(package, "G4")
        assert {line.verdict for line in checks.comparisons(package, seen, "G4")} <= set(_GOOD)
        assert {name: len(reading.values) for name, reading in seen.readings.items()} == _TOLD[target]
        _more(seen, _TRAJECTORY, 1, End("/script"))
        assert [line.verdict for line in checks.comparisons(package, seen, "G4")].count(FAILED) == 1


def ends(interface: Any, side: str, sides: Any, gate: str) -> list[End]:
    """Return the ends of one side that run at a gate."""
    qos = {each["full_name"]: each["qos"] for each in interface.get(side, ())}
    return [
        End(node, interface["type"], *(qos.get(node, {}).get(policy, "") for policy in ("reliability", "durability")))
        for node, since in sides[side].items()
        if since <= gate
    ]


def positions(package: Package) -> Iterator[tuple[str, float]]:
    """Yield every joint that a controller or an adapter has, in the middle of its range."""
    managers = package.contract["managers"].values()
    owners = [each for manager in managers for each in manager["controllers"].values()]
    owners += package.contract.get("adapters", {}).values()
    for joint in sorted({joint for each in owners for joint in each["joints"]}):
        limits = package.contract["joint_limits"].get(joint, {})
        yield joint, (limits.get("lower", 0.0) + limits.get("upper", 0.0)) / 2.0


def unshown(package: Package, gate: str) -> set[str]:
    """Return the joints of components that no person has activated, and those that follow them: none has a state."""
    states = {name: state for each in package.plan["states"].values() for name, state in each["hardware"].items()}
    asleep = {
        joint.get("name", "")
        for system in package.description.iterfind("ros2_control")
        if gate < "G5" and states.get(system.get("name", "")) == "unconfigured"
        for joint in system.iterfind("joint")
    }
    followed = ((joint.get("name", ""), joint.find("mimic")) for joint in package.description.iterfind("joint"))
    return asleep | {name for name, mimic in followed if mimic is not None and mimic.get("joint") in asleep}


def described(package: Package, seen: Seen, asleep: Collection[str] = ()) -> None:
    """See the transforms and the text of the description; rotations by products of one about each axis."""
    seen.answers["robot_description"] = package.description
    for joint in package.description.iterfind("joint"):
        (parent,), (child,) = ([each.get("link", "") for each in joint.iterfind(end)] for end in ("parent", "child"))
        if joint.get("name") in asleep:
            continue
        if joint.get("type") != "fixed":
            seen.moving[child] = {parent}
            continue
        origin = joint.find("origin")
        xyz, rpy = ("0 0 0", "0 0 0") if origin is None else (origin.get("xyz", "0 0 0"), origin.get("rpy", "0 0 0"))
        place = tuple(map(float, xyz.split())), quaternion([*map(float, rpy.split())])
        seen.fixed[child] = {(parent, *place)}


def answered(package: Package, seen: Seen, gate: str) -> None:
    """Answer as the managers, the managed nodes and the parameters of the package."""
    for manager in package.contract["managers"].values():
        node = f"{manager['namespace'].rstrip('/')}/controller_manager"
        stated, controllers = package.plan["states"][node], []
        for name, state in stated["controllers"].items():
            facts = manager["controllers"][name]
            state = "active" if gate == "G7" and facts["active"] else state
            claims = facts["command_interfaces"] if state == "active" else []
            made = SimpleNamespace(name=name, state=state, type=facts["plugin"], claimed_interfaces=[*claims])
            controllers.append(made)
        seen.answers[f"{node}/list_controllers"] = SimpleNamespace(controller=controllers)
        labels = {name: SimpleNamespace(label=state) for name, state in stated["hardware"].items()}
        parts = [SimpleNamespace(name=name, state=label) for name, label in labels.items()]
        seen.answers[f"{node}/list_hardware_components"] = SimpleNamespace(component=parts)
    adapters = {f"/{name}" for name in package.contract.get("adapters", ())}
    on_real = any("unconfigured" in each["hardware"].values() for each in package.plan["states"].values())
    for node, stated in package.plan["lifecycle"].items():
        state = "active" if gate == "G7" and node in adapters and on_real else stated
        seen.answers[f"{node}/get_state"] = SimpleNamespace(current_state=SimpleNamespace(label=state))
    for node, written in package.parameters.items():
        seen.answers[f"{node}/get_parameters"] = SimpleNamespace(values=[*map(parameter, written.values())])


def parameter(value: Any) -> Any:
    """Return a value as rcl_interfaces/msg/ParameterValue has it; the numbers are those of ParameterType."""
    first = value[0] if isinstance(value, list) else value
    kinds = ((bool, 1, "bool"), (int, 2, "integer"), (float, 3, "double"), (str, 4, "string"))
    number, word = next((number, word) for kind, number, word in kinds if isinstance(first, kind))
    listed = isinstance(value, list)
    return SimpleNamespace(**{"type": number + 5 * listed, f"{word}{'_array' if listed else ''}_value": value})


@pytest.mark.parametrize("gate", ["G4", "G7"])
@pytest.mark.parametrize("target", ["mock", "real"])
@pytest.mark.parametrize("cell", EVERY_CELL)
def test_the_graph_of_the_package_passes(cell: str, target: str, gate: str, tmp_path: Path) -> None:
    package = package_of(cell, target, tmp_path)
    lines = list(comparisons(package, right(package, gate), gate))
    assert [line for line in lines if line.verdict not in _GOOD] == []
    vendor = {"vendor"} if package.plan["readings"] else set()
    assert {line.part for line in lines} == {"graph", "flow", "tf", "control", "parameters"} | vendor


def _gone(seen: Seen, name: str, side: int) -> None:
    sides = [*seen.ends[name]]
    sides[side] = sides[side][1:]
    seen.ends[name] = (sides[0], sides[1])


def _more(seen: Seen, name: str, side: int, end: End) -> None:
    sides = [*seen.ends[name]]
    sides[side] = [*sides[side], end]
    seen.ends[name] = (sides[0], sides[1])


def _other(seen: Seen, name: str, side: int, **fields: str) -> None:
    sides = [*seen.ends[name]]
    sides[side] = [replace(sides[side][0], **fields), *sides[side][1:]]
    seen.ends[name] = (sides[0], sides[1])


def _hashed(seen: Seen, name: str, *hashes: str) -> None:
    """Give the ends of a topic a hash each; a listener that the gate does not ask for is there."""
    (source,), _ = seen.ends[name]
    ends_of = [replace(source, type_hash=hashes[0]), replace(source, node="/task", type_hash=hashes[1])]
    seen.ends[name] = (ends_of[:1], ends_of[1:])


def _controller(seen: Seen, name: str, **fields: Any) -> None:
    listed = seen.answers["/controller_manager/list_controllers"].controller
    vars(next(each for each in listed if each.name == name)).update(fields)


def _moved(seen: Seen, child: str, by_m: float) -> None:
    ((parent, at, turned),) = seen.fixed[child]
    seen.fixed[child] = {(parent, (at[0] + by_m, *at[1:]), turned)}


def _turned(seen: Seen, child: str) -> None:
    ((parent, at, _),) = seen.fixed[child]
    seen.fixed[child] = {(parent, at, quaternion((0.0, 0.0, 2.0)))}


def _set(seen: Seen, node: str, place: int, value: Any) -> None:
    seen.answers[f"{node}/get_parameters"].values[place] = parameter(value)


def _stream(seen: Seen, name: str, late_s: float = 0.0, every: int = 1, frame: str | None = None) -> None:
    before, seen.streams[name] = seen.streams[name], Stream()
    for number, (arrived_s, age_s) in enumerate(zip(before.arrivals, before.ages, strict=True)):
        if number % every == 0:
            stamp = (arrived_s - age_s - late_s, next(iter(before.frames)) if frame is None else frame)
            seen.streams[name].take(arrived_s, stamp)
    seen.streams[name].joints = before.joints


def _took(seen: Seen, share: float) -> None:
    times = seen.cycles["/controller_manager"].times_us
    for place in range(int(share * len(times))):
        times[place] = 2100.0


def _diagnosed(seen: Seen, level: int, message: str, **figures: str) -> None:
    statuses = seen.cycles["/controller_manager"].statuses
    statuses.append(
        (level, message, {**statuses[-1][2], **{key.replace("_of_", "."): value for key, value in figures.items()}})
    )


_TRAJECTORY = "/arm_trajectory/follow_joint_trajectory"
_GOOD = (PASSED, SEEN)
_IO = ("safety_mode", "robot_mode", "robot_program_running")
_SAID = (*(f"/arm_io/{name}" for name in _IO), "/arm_speed/speed_scaling", "/arm_software/get_robot_software_version")
_TOLD: dict[str, dict[str, int]] = {"mock": {}, "real": dict.fromkeys(_SAID, 1)}
_STATES, _POSE = "/joint_states", "/object_pose"
_WRONGS: dict[str, tuple[Callable[[Seen], object], str, str]] = {
    "no publisher": (lambda seen: _gone(seen, _STATES, 0), "/joint_states, publishers", "/joint_states is missing"),
    "no subscriber": (lambda seen: _gone(seen, _STATES, 1), "/joint_states, subscribers", "is missing"),
    "a second publisher": (
        lambda seen: _more(seen, _STATES, 0, End("/other", "sensor_msgs/msg/JointState", "reliable", "volatile")),
        "/joint_states, publishers",
        "/other is not a declared publisher",
    ),
    "a second commander": (
        lambda seen: _more(seen, _TRAJECTORY, 1, End("/script")),
        f"{_TRAJECTORY}, clients",
        "/script is not a declared client",
    ),
    "a second server": (lambda seen: _more(seen, _TRAJECTORY, 0, End("/b")), f"{_TRAJECTORY}, server", "/b is not"),
    "no server": (lambda seen: _gone(seen, _TRAJECTORY, 0), f"{_TRAJECTORY}, server", "/arm_trajectory is missing"),
    "another type": (
        lambda seen: _other(seen, _POSE, 0, type="geometry_msgs/msg/Pose"),
        "/object_pose, publishers",
        "has type geometry_msgs/msg/Pose, expected geometry_msgs/msg/PoseStamped",
    ),
    "less reliable": (
        lambda seen: _other(seen, _POSE, 0, reliability="best_effort"),
        "/object_pose, publishers",
        "has reliability best_effort, expected reliable",
    ),
    "not latched": (
        lambda seen: _other(seen, "/tf_static", 0, durability="volatile"),
        "/tf_static, publishers",
        "has durability volatile, expected transient_local",
    ),
    "ends that do not match": (
        lambda seen: _other(seen, "/tf_static", 0, durability="volatile"),
        "/tf_static, QoS",
        "/robot_state_publisher offers volatile, /move_group requests transient_local",
    ),
    "two nodes of a name": (lambda seen: seen.nodes.append("/perception"), "node names", "/perception runs 2 times"),
    "too slow": (lambda seen: _stream(seen, _STATES, every=2), "/joint_states", "250 Hz"),
    "too old": (lambda seen: _stream(seen, _POSE, late_s=0.5), "/object_pose", "0.5 s old"),
    "in the future": (lambda seen: _stream(seen, _POSE, late_s=-0.5), "/object_pose", "100 stamps in the future"),
    "another frame": (
        lambda seen: _stream(seen, _POSE, frame="world"),
        "/object_pose",
        "frame world, expected camera_color_optical_frame",
    ),
    "back in time": (
        lambda seen: seen.streams[_POSE].take(110.0, (109.8, "camera_color_optical_frame")),
        "/object_pose",
        "1 stamps before an earlier one",
    ),
    "nothing": (lambda seen: seen.streams.pop(_POSE), "/object_pose", "0 Hz"),
    "a joint is missing": (
        lambda seen: seen.streams[_STATES].joints.pop("arm_elbow_joint"),
        "joint states",
        "arm_elbow_joint is missing",
    ),
    "beyond a limit": (
        lambda seen: seen.streams[_STATES].take_joints(["arm_elbow_joint"], [3.5]),
        "joint states",
        "arm_elbow_joint is beyond its limits",
    ),
    "no number": (
        lambda seen: seen.streams[_STATES].take_joints(["arm_elbow_joint"], [math.nan]),
        "joint states",
        "a position is not a number",
    ),
    "a joint moves": (
        lambda seen: seen.streams[_STATES].take_joints(["arm_elbow_joint"], [0.01]),
        "motion",
        "arm_elbow_joint moved by 0.0100",
    ),
    "a frame is missing": (lambda seen: seen.fixed.pop("tcp"), "frames of the description", "tcp is missing"),
    "a moving frame is missing": (
        lambda seen: seen.moving.pop("arm_wrist_3_link"),
        "frames of the description",
        "arm_wrist_3_link is missing",
    ),
    "two authorities": (
        lambda seen: seen.fixed["tcp"].add(("arm_tool0", (0.0, 0.0, 0.2), (0.0, 0.0, 0.0, 1.0))),
        "parents and fixed transforms",
        "tcp has 2 different transforms",
    ),
    "fixed and moving": (
        lambda seen: seen.moving.update(tcp={"arm_tool0"}),
        "parents and fixed transforms",
        "tcp is on /tf and on /tf_static",
    ),
    "another place": (
        lambda seen: _moved(seen, "tcp", 0.003),
        "parents and fixed transforms",
        "tcp is 3.00 mm and 0.00 deg from its place",
    ),
    "another turn": (lambda seen: _turned(seen, "tcp"), "parents and fixed transforms", "tcp is 0.00 mm and "),
    "another parent": (
        lambda seen: seen.moving.update(arm_forearm_link={"world"}),
        "parents and fixed transforms",
        "arm_forearm_link is below world, expected arm_upper_arm_link",
    ),
    "a claim before its gate": (
        lambda seen: _controller(seen, "arm_trajectory", state="active"),
        "/controller_manager, controllers",
        "arm_trajectory is active, expected inactive",
    ),
    "a broadcaster that is inactive": (
        lambda seen: _controller(seen, "joint_states", state="inactive"),
        "/controller_manager, controllers",
        "joint_states is inactive, expected active",
    ),
    "another controller": (
        lambda seen: _controller(seen, "arm_trajectory", type="joint_trajectory_controller/JointTrajectoryController"),
        "/controller_manager, controllers",
        "expected ur_controllers/ScaledJointTrajectoryController",
    ),
    "a claim of another": (
        lambda seen: _controller(seen, "joint_states", claimed_interfaces=["arm_elbow_joint/position"]),
        "/controller_manager, controllers",
        "joint_states claims arm_elbow_joint/position, expected none",
    ),
    "hardware in another state": (
        lambda seen: setattr(
            seen.answers["/controller_manager/list_hardware_components"].component[0].state, "label", "inactive"
        ),
        "/controller_manager, hardware",
        "is inactive, expected active",
    ),
    "a managed node that is inactive": (
        lambda seen: setattr(seen.answers["/perception/get_state"].current_state, "label", "inactive"),
        "/perception, lifecycle",
        "inactive",
    ),
    "another parameter": (
        lambda seen: _set(seen, "/controller_manager", 0, 125),
        "/controller_manager",
        "update_rate is 125",
    ),
    "parameters of which one is not declared": (
        lambda seen: seen.answers["/controller_manager/get_parameters"].values.clear(),
        "/controller_manager",
        "values answered",
    ),
    "cycles that take too long": (
        lambda seen: _took(seen, 0.002),
        "/controller_manager, missed cycles",
        "2 of 1000 cycles took longer, the longest 2.1 ms",
    ),
    "a manager that calls itself irregular": (
        lambda seen: _diagnosed(seen, 1, "Controller Manager has bad periodicity : 490 Hz"),
        "/controller_manager, update rate",
        "bad periodicity",
    ),
    "a manager that is slow": (
        lambda seen: _diagnosed(seen, 0, "", periodicity_of_average="400.0"),
        "/controller_manager, update rate",
        "400 Hz on average",
    ),
    "a manager of another rate": (
        lambda seen: _diagnosed(seen, 0, "", update_rate="250"),
        "/controller_manager, update rate",
        "250 Hz is set",
    ),
    "a figure that is no number": (
        lambda seen: _diagnosed(seen, 0, "", periodicity_of_average="fast"),
        "/controller_manager, update rate",
        "nan Hz on average",
    ),
    "a node in simulated time": (
        lambda seen: setattr(seen.answers["/perception/use_sim_time"].values[0], "bool_value", True),
        "use_sim_time",
        "/perception takes its time from /clock",
    ),
    "a protective stop that was reset meanwhile": (
        lambda seen: seen.readings["/arm_io/safety_mode"].values.append(3),
        "/arm_io/safety_mode, safety state",
        "PROTECTIVE_STOP",
    ),
    "open brakes before a claim": (
        lambda seen: setattr(seen.readings["/arm_io/robot_mode"], "values", [7]),
        "/arm_io/robot_mode, robot mode",
        "RUNNING",
    ),
    "a value without a name": (
        lambda seen: setattr(seen.readings["/arm_io/robot_mode"], "values", [42]),
        "/arm_io/robot_mode, robot mode",
        "42",
    ),
    "other software in the robot": (
        lambda seen: setattr(seen.readings["/arm_software/get_robot_software_version"], "values", ["5.2.0"]),
        "/arm_software/get_robot_software_version, software of the robot",
        "5.2.0",
    ),
    "another definition of a type": (
        lambda seen: _hashed(seen, _POSE, "RIHS01_0", "RIHS01_1"),
        "type hashes",
        "/object_pose has RIHS01_0 at /perception, RIHS01_1 at /task",
    ),
    "another description": (
        lambda seen: seen.answers.update(robot_description=fromstring('<robot name="ur5e_pick"/>')),
        "robot_description",
        "without /robot[ur5e_pick]/link[world]",
    ),
}


@pytest.mark.parametrize("wrong", _WRONGS)
def test_each_wrong_is_named_in_its_line(wrong: str, tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    change, subject, words = _WRONGS[wrong]
    change(seen)
    failed = [line for line in comparisons(package, seen, "G4") if line.verdict not in _GOOD]
    assert [line for line in failed if (line.subject, line.verdict) == (subject, FAILED) and words in line.seen], failed
    assert len(failed) <= 2


def test_ends_of_one_definition_pass_and_ends_without_a_hash_have_no_line(tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    assert not [line for line in comparisons(package, seen, "G4") if line.subject == "type hashes"]
    _hashed(seen, _POSE, "RIHS01_0", "RIHS01_0")
    (line,) = [line for line in comparisons(package, seen, "G4") if line.subject == "type hashes"]
    assert (line.verdict, line.seen) == (PASSED, "1 topics whose ends carry one")


@pytest.mark.parametrize(
    ("gate", "mode", "verdict"),
    [("G3", 7, SEEN), ("G4", 5, PASSED), ("G4", 7, FAILED), ("G7", 7, PASSED), ("G7", 5, FAILED)],
)
def test_what_a_device_must_say_depends_on_the_gate(gate: str, mode: int, verdict: str, tmp_path: Path) -> None:
    """UR: ur_dashboard_msgs/msg/RobotMode.msg; the brakes are closed at G4 (IDLE, 5), and open at G7 (RUNNING, 7)."""
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, gate)
    seen.readings["/arm_io/robot_mode"].values = [mode]
    lines = {line.subject: line for line in comparisons(package, seen, gate)}
    assert lines["/arm_io/robot_mode, robot mode"].verdict == verdict


@pytest.mark.parametrize(("gate", "runs", "verdict"), [("G3", True, SEEN), ("G4", True, FAILED), ("G7", True, PASSED)])
def test_a_program_that_runs_before_motion_is_authorized_fails(
    gate: str, runs: bool, verdict: str, tmp_path: Path
) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, gate)
    seen.readings["/arm_io/robot_program_running"].values = [runs]
    lines = {line.subject: line for line in comparisons(package, seen, gate)}
    assert lines["/arm_io/robot_program_running, program"].verdict == verdict


def test_what_no_device_says_and_no_manager_reports_is_unknown(tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    seen.readings.clear()
    seen.cycles.clear()
    seen.answers["/perception/use_sim_time"] = None
    lines = {line.subject: line for line in comparisons(package, seen, "G4") if line.verdict not in _GOOD}
    assert {line.verdict for line in lines.values()} == {UNKNOWN}
    assert {*lines} == {
        *("/controller_manager, update rate", "/controller_manager, missed cycles", "use_sim_time"),
        *(
            "/arm_io/safety_mode, safety state",
            "/arm_io/robot_mode, robot mode",
            "/arm_io/robot_program_running, program",
        ),
        *("/arm_speed/speed_scaling, speed scaling",),
        *("/arm_software/get_robot_software_version, software of the robot",),
    }
    seen.uninstalled |= {"pal_statistics_msgs/msg/StatisticsValues", "ur_dashboard_msgs/msg/SafetyMode"}
    lines = {line.subject: line for line in comparisons(package, seen, "G4")}
    for subject in ("/controller_manager, missed cycles", "/arm_io/safety_mode, safety state"):
        assert "is not installed here" in lines[subject].seen


def test_of_a_graph_that_is_not_there_nothing_is_said_to_be_right(tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    lines = [line for line in comparisons(package, Seen(listened_s=_FOR_S), "G4") if line.part in ("control", "vendor")]
    assert len(lines) > 8
    assert {line.verdict for line in lines} == {UNKNOWN}


def test_an_hour_of_recording_must_fit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    for name in (_STATES, _POSE):
        seen.streams[name].size = 453 * len(seen.streams[name].arrivals)
    # 500 Hz and 10 Hz of 453 byte each, with 31 for the record of MCAP and 16 for its index: 510 * 500 byte/s.
    free = {"blocks": 510 * 500 * 3600}
    monkeypatch.setattr(os, "statvfs", lambda _: SimpleNamespace(f_bavail=free["blocks"], f_frsize=1))
    line = space(package, seen, tmp_path, "G4")
    assert (line.part, line.verdict, line.seen) == ("host", PASSED, "0.918 GB free")
    assert "15.3 MB a minute" in line.expected
    free["blocks"] -= 1
    assert space(package, seen, tmp_path, "G4").verdict == FAILED
    seen.streams.pop(_POSE)
    assert space(package, seen, tmp_path, "G4").verdict == UNKNOWN


@pytest.mark.parametrize("service", ["list_controllers", "list_hardware_components", "get_state", "get_parameters"])
def test_what_is_not_answered_is_unknown(service: str, tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    asked = [name for name in seen.answers if name.endswith(f"/{service}") and not name.startswith("/task/")]
    seen.answers |= dict.fromkeys(asked)
    lines = [line for line in comparisons(package, seen, "G4") if line.verdict not in _GOOD]
    assert {(line.verdict, line.seen) for line in lines} == {(UNKNOWN, "no answer")}
    assert len(lines) == len(asked)


def test_nodes_that_nobody_declared_and_types_that_are_not_installed_are_unknown(tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    seen.nodes += ["/joystick", "/_ros2cli_1234", "/move_group_private_94", "/rviz2"]
    seen.uninstalled.add("geometry_msgs/msg/PoseStamped")
    lines = [line for line in comparisons(package, seen, "G4") if line.verdict not in _GOOD]
    assert [(line.verdict, line.subject, line.seen) for line in lines] == [
        (UNKNOWN, "nodes beside the package", "/joystick"),
        (UNKNOWN, "/object_pose", "geometry_msgs/msg/PoseStamped is not installed here"),
    ]


def test_a_motion_client_that_runs_before_its_gate_fails_there_and_passes_in_it(tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    seen.nodes.append("/task")
    wrong = [line for line in comparisons(package, seen, "G4") if line.verdict not in _GOOD]
    assert [(line.verdict, line.subject, line.seen) for line in wrong] == [
        (FAILED, "nodes of later gates", "/task runs, and G7 starts it")
    ]
    assert [line for line in comparisons(package, right(package, "G7"), "G7") if line.verdict not in _GOOD] == []


def test_figures_of_a_topic_are_shown_beside_what_is_wrong_with_it(tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    seen.streams["/object_pose"].frames.add("world")
    (line,) = (line for line in comparisons(package, seen, "G4") if line.verdict == FAILED)
    rate = package.contract["interfaces"]["/object_pose"]["rate_hz"]
    assert line.seen.startswith(
        f"frame world, expected camera_color_optical_frame; in all {rate:g} Hz, gaps {1e3 / rate:.4g} ms"
    )


@pytest.mark.parametrize("named", ["", "nothing"])
def test_a_folder_of_evidence_that_is_not_there_is_refused_before_anything_is_looked_at(
    named: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        observe_program.main(["--package", "package", "--evidence", named])
    assert (ended.value.code, f"must be a folder that is there, got '{named}'" in capsys.readouterr().err) == (2, True)
    assert list(tmp_path.iterdir()) == []


def test_what_stops_a_gate_is_printed_last(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    seen.nodes += ["/task", "/joystick"]
    monkeypatch.setattr(observe_program, "looked", lambda *_: seen)
    assert observe_program.main(["--package", tmp_path.as_posix(), "--gate", "G4"]) == 1
    verdicts = [line.split(" ")[0] for line in capsys.readouterr().out.splitlines()[:-1]]
    assert list(dict.fromkeys(verdicts)) == ["PASSED", "SEEN", "UNKNOWN", "FAILED"]


def test_observers_of_several_computers_may_look_at_the_same_time(tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seen = right(package, "G4")
    seen.nodes += ["/observe", "/observe"]
    assert [line for line in comparisons(package, seen, "G4") if line.verdict not in _GOOD] == []


def test_reports_that_are_written_in_the_same_second_are_both_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    seconds = [1764331200.0]
    clock = SimpleNamespace(
        strftime=time.strftime,
        gmtime=lambda: time.gmtime(seconds[0]),
        sleep=lambda for_s: seconds.append(seconds.pop() + for_s),
    )
    monkeypatch.setattr(observe_program, "time", clock)
    for host in ("control_pc", "planner_pc"):
        asked = {"gate": "G4", "target": "real", "host": host, "seconds": 1.0}
        observe_program.leave([Line("graph", "/x", PASSED, "", "")], tmp_path, package, asked)
    names = sorted(file.name for file in tmp_path.glob("observe-G4-*.json"))
    assert names == ["observe-G4-20251128T120000Z.json", "observe-G4-20251128T120001Z.json"]


def test_what_a_later_gate_starts_is_due_from_then_on(tmp_path: Path) -> None:
    package = package_of("ur5e_pick", "real", tmp_path)
    early = right(package, "G4")
    lines = [line for line in comparisons(package, early, "G7") if line.verdict == FAILED]
    named = {name for line in lines for name in ("/task is missing", "arm_trajectory is inactive") if name in line.seen}
    assert named == {"/task is missing", "arm_trajectory is inactive"}


def test_stamps_of_two_publishers_that_interleave_are_in_no_order(tmp_path: Path) -> None:
    package = package_of("dual_ur", "real", tmp_path)
    assert len(package.plan["ends"][_STATES]["sources"]) == 2
    seen = right(package, "G4")
    seen.streams[_STATES].backward = 100
    assert [line for line in comparisons(package, seen, "G4") if line.verdict not in _GOOD] == []


def test_joint_states_of_two_publishers_that_alternate_are_both_read() -> None:
    for publishers in range(2, 10):
        read = {number % publishers for number in range(0, 2000, observe_listener.EACH)}
        assert read == set(range(publishers))


@pytest.mark.parametrize("arguments", [("--for", "nan"), ("--for", "inf"), ("--for", "-1"), ("--for", "soon")])
def test_a_time_that_is_no_time_is_a_wrong_use(arguments: tuple[str, ...], tmp_path: Path) -> None:
    with pytest.raises(SystemExit) as ended:
        observe_program.main(["--package", str(tmp_path), *arguments])
    assert ended.value.code == 2


def test_a_folder_that_is_no_package_is_a_wrong_use(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        observe_program.main(["--package", str(tmp_path)])
    assert ended.value.code == 2
    assert "--package must be the share folder of this package" in capsys.readouterr().err


def test_every_node_of_a_cell_on_two_computers_is_on_one_of_them() -> None:
    contract = contract_data(built("fr3_hand").texts["contract.json"])
    plan = json.loads(built("fr3_hand").texts["config/observe.json"])["real"]
    assert sorted(node for nodes in plan["hosts"].values() for node in nodes) == sorted(plan["nodes"])
    for name in ("move_group", "task", "controller_manager", "arm_trajectory"):  # those with a clock of their own
        assert f"/{name}" in plan["hosts"][contract["clock_of"][name]]
    assert "hosts" not in json.loads(built("minimal").texts["config/observe.json"])["real"]


@pytest.mark.parametrize(("hosts", "named", "host"), [({"a": [], "b": []}, "b", "b"), ({}, None, platform.node())])
def test_a_report_names_its_host(hosts: dict[str, list[str]], named: str | None, host: str) -> None:
    assert observe_program.host_of(hosts, named, pytest.fail) == host


def test_a_computer_that_is_no_host_of_the_cell_must_be_named() -> None:
    refused: list[str] = []
    observe_program.host_of({"control_pc": [], "planner_pc": []}, "elsewhere", refused.append)
    assert refused == ["--host must be one of control_pc, planner_pc, got elsewhere"]


def test_a_message_that_is_too_short_for_its_header_is_named() -> None:
    seen = Seen()
    kind = type("PoseStamped", (), {})
    observe_listener.Listener(seen).stream(_POSE, kind, True, b"\0\1\0\0", 1.0)
    assert seen.streams[_POSE].frames == {"of a message of 4 bytes"}


@pytest.mark.parametrize("frame", ["", "a", "abc", "a_frame"])
@pytest.mark.parametrize("little", [True, False])
def test_time_of_a_cycle_is_read_from_a_serialized_message(frame: str, little: bool) -> None:
    """Definitions: pal_statistics 1.4.0, pal_statistics_msgs/msg/StatisticsValues.msg."""
    store = get_typestore(Stores.ROS2_JAZZY)
    kind = "pal_statistics_msgs/msg/StatisticsValues"
    store.register(get_types_from_msg("std_msgs/Header header\nfloat64[] values\nuint32 names_version", kind))
    stamp = store.types["builtin_interfaces/msg/Time"](sec=1, nanosec=2)
    header = store.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame)
    message = store.types[kind](header=header, values=np.array([1.5, 2.5, 900.25]), names_version=7)
    data = bytes(store.serialize_cdr(message, kind, little_endian=little))
    assert observe_listener.cycle_of(data, 2) == (7, 900.25)


def test_cycles_are_taken_by_the_place_that_the_names_of_their_version_say(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = Seen()
    listener = observe_listener.Listener(seen)
    names = SimpleNamespace(names=["a", "controller_manager.total_time"], names_version=3)
    monkeypatch.setattr(observe_listener, "deserialized", lambda data, kind: names)
    said = iter([(3, 0.0), (3, 450.0), (4, 0.0)])
    monkeypatch.setattr(observe_listener, "cycle_of", lambda data, place: next(said))
    listener.names("/left/controller_manager", None, b"", 0.0)
    listener.cycle("/left/controller_manager", b"", 1.0)
    listener.cycle("/left/controller_manager", b"", 1.0)  # names of version 4 did not come yet
    assert [*seen.cycles["/left/controller_manager"].times_us] == [450.0]


def test_a_cycle_that_is_too_short_to_be_read_is_left_out() -> None:
    seen = Seen()
    observe_listener.Listener(seen).cycle("/controller_manager", b"\0\1\0\0", 1.0)
    assert seen.cycles == {}


def test_of_what_a_device_says_quickly_the_last_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = Seen()
    listener = observe_listener.Listener(seen)
    monkeypatch.setattr(observe_listener, "deserialized", lambda data, kind: SimpleNamespace(mode=data[0]))
    for number in range(10):
        listener.reading("/mode", None, ["mode"], bytes([number]), 100.0 + number * 0.01)
    listener.finish()
    assert seen.readings["/mode"].values == [0, 9]


def test_of_numbers_the_lowest_and_the_highest_are_kept() -> None:
    reading = Reading()
    for value in (0.5, 0.75, 0.25, 1.0):
        reading.take(value)
    assert reading.values == [0.25, 1.0]


def test_a_diagnosis_goes_to_the_manager_that_it_names(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = Seen()
    listener = observe_listener.Listener(seen)
    figure = SimpleNamespace(key="update_rate", value="500")
    said = [
        SimpleNamespace(name=f"{name}: {what}", level=level, message=name, values=[figure])
        for name, what, level in (
            ("/a/controller_manager", "Controller Manager Activity", b"\1"),
            ("/a/controller_manager", "Controllers Activity", b"\2"),
            ("joint", "Controller Manager Activity", b"\2"),
        )
    ]
    monkeypatch.setattr(observe_listener, "deserialized", lambda data, kind: SimpleNamespace(status=said))
    listener.diagnosis(["/a/controller_manager", "/b/controller_manager"], None, b"", 0.0)
    assert {node: found.statuses for node, found in seen.cycles.items()} == {
        "/a/controller_manager": [(1, "/a/controller_manager", {"update_rate": "500"})]
    }


def test_stamp_and_frame_are_read_from_a_serialized_message() -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    stamps, header, joints = (
        store.types[name]
        for name in (
            "builtin_interfaces/msg/Time",
            "std_msgs/msg/Header",
            "sensor_msgs/msg/JointState",
        )
    )
    stamped = header(stamp=stamps(sec=1_700_000_000, nanosec=250_000_000), frame_id="camera_frame")
    nothing = np.zeros(0)
    message = joints(header=stamped, name=["a"], position=np.ones(1), velocity=nothing, effort=nothing)
    data = bytes(store.serialize_cdr(message, "sensor_msgs/msg/JointState"))
    assert observe_listener.stamp_of(data) == (1_700_000_000.25, "camera_frame")
    other_order = bytes(store.serialize_cdr(message, "sensor_msgs/msg/JointState", little_endian=False))
    assert observe_listener.stamp_of(other_order) == (1_700_000_000.25, "camera_frame")


_TELL = {"get_robot_software_version"}
"""Services of devices that take no argument and change nothing: their requests are empty messages."""
_LOOKS = {"create_subscription", "create_client", "create_node", "call_async"}
_LOOKS |= {"destroy_node", "destroy_client", "destroy_subscription"}


def test_the_program_makes_nothing_that_could_change_a_graph() -> None:
    texts = built("ur5e_pick").texts
    source = "\n".join(
        text.replace("from __future__ import annotations\n", "")
        for path, text in texts.items()
        if path.startswith("scripts/observe")
    )
    called = {node.attr for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Attribute)}
    assert {name for name in called if re.match("create_|destroy_|call|publish|send|set_parameters", name)} == _LOOKS
    assert "ActionClient" not in source
    # What is called is on the list; each of them answers, and changes nothing.
    assert {kind.split("/")[2] for kind in observe_program.READS.values()} == {
        "ListControllers",
        "ListHardwareComponents",
        "GetState",
        "GetParameters",
    }
    found = [load_device(name).value for name in device_names()]
    readings = [reading for device in found if device is not None for reading in device.model.readings]
    told = {reading.service for reading in readings if reading.service is not None}
    assert told == _TELL


@every_build
def test_its_enclave_may_look_and_nothing_else(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    enclave = json.loads(texts["config/observe.json"])["enclave"]
    (profile,) = policy_of(texts).findall(f".//enclave[@path='{enclave}']/profiles/profile")
    said = {topic.text for topics in profile.findall("topics[@publish='ALLOW']") for topic in topics}
    assert said <= {"/rosout", "/parameter_events"}
    assert not [tag for tag in profile if tag.tag == "actions" or tag.get("reply")]
    asked = {(name.text or "").rpartition("/")[2] for tag in profile.findall("services") for name in tag}
    read = {*observe_program.READS, "list_hardware_interfaces", "get_available_transitions"} | _TELL
    assert asked <= read
    may = permissions(texts)[enclave]
    for interface in contract_data(texts["contract.json"])["interfaces"]:
        assert (
            may.allow("subscribe", interface)
            or contract_data(texts["contract.json"])["interfaces"][interface]["kind"] != "topic"
        )


def test_words_of_a_node_are_text_in_the_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = Line("graph", "/x", FAILED, "none", "a|b\n# <script>\x1b[31m")
    attempt = {"attempt_id": "1", "cell": "c", "configuration_id": "cfg", "gate": "G4", "target": "real"}
    observe_program.write([line], tmp_path, attempt)
    report = (tmp_path / "observe-G4-1.md").read_text(encoding="utf-8")
    assert "| FAILED | graph | /x | none | a\\|b?# \\<script\\>?\\[31m |" in report
    assert json.loads((tmp_path / "observe-G4-1.json").read_text(encoding="utf-8"))["lines"][0]["seen"] == line.seen
    with pytest.raises(FileExistsError):  # evidence is never replaced
        observe_program.write([line], tmp_path, attempt)
