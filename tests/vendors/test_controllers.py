"""Controllers that the vendor ships, each by the name of its kind, against what its sources say release by release."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import pytest

from cellc.compiler.cell.control import Controller
from tests.consumers.permissions import Permissions, Right, permissions
from tests.oracles import here
from tests.vendors.oracle import counted, facts
from tests.vendors.packages import CASES, Case, RealTarget, real_target

_ADDED = """\
    arm_wrench: {type: force_torque_sensor_broadcaster, device: arm, parameters: {frame_id: tcp}}
    arm_force: {type: force_mode, device: arm, client: task, active: false}
    arm_guiding: {type: freedrive, device: arm, client: task, active: false}
    arm_passed: {type: passthrough_trajectory, device: arm, client: task, active: false}
"""
_KINDS = {
    "io_and_status": "io_and_status_controller",
    "speed_scaling_state_broadcaster": "speed_scaling_state_broadcaster",
    "tcp_pose_broadcaster": "tcp_pose_broadcaster",
    "configuration": "ur_configuration_controller",
    "force_torque_sensor_broadcaster": "force_torque_sensor_broadcaster",
    "force_mode": "force_mode_controller",
    "freedrive": "freedrive_mode_controller",
    "passthrough_trajectory": "passthrough_trajectory_controller",
}
"""Kinds of the catalog → the names of the vendor's own configuration."""
_GPIOS = {"freedrive": "freedrive_mode"}
"""Ways of commanding → the gpios whose names stand for them."""
_MOVING = ("force_mode", "freedrive", "passthrough_trajectory")

of_the_arm = pytest.mark.parametrize(
    "case",
    here(
        [
            Case(case.cell, case.release, added=_ADDED)
            for case in CASES
            if case.cell == "ur5e_pick" and case.release.device == "ur5e"
        ]
    ),
    ids=str,
)
every_kind = pytest.mark.parametrize("kind", _KINDS)


def _controller(target: RealTarget, kind: str) -> Controller:
    (found,) = (controller for controller in target.cell.controllers if controller.kind == kind)
    return found


def _told(case: Case, kind: str) -> Any:
    return facts(case.release, "controllers")["controllers"][_KINDS[kind]]


@cache
def _policy(case: Case) -> dict[str, Permissions]:
    return permissions(real_target(case).texts)


@of_the_arm
@every_kind
def test_the_plugin_of_a_kind_is_the_vendor_s_and_its_package_is_depended_on(case: Case, kind: str) -> None:
    target, told = real_target(case), _told(case, kind)
    controller = _controller(target, kind)
    manager = target.yaml("config/controllers.yaml")["controller_manager"]["ros__parameters"]
    assert manager[controller.name]["type"] == told["type"]
    assert f"<exec_depend>{told['package']}</exec_depend>" in re.sub(
        r' version_gte="[^"]*"', "", target.texts["package.xml"]
    )


@of_the_arm
@every_kind
def test_a_kind_takes_the_interfaces_that_its_plugin_takes(case: Case, kind: str) -> None:
    target, told = real_target(case), _told(case, kind)["claims"]
    controller = _controller(target, kind)
    for side, names in (("command", controller.claims("real")), ("state", controller.state_interfaces)):
        listed = [interface.replace("<tf_prefix>", target.prefix) for interface in told[side]["interfaces"]]
        if (
            kind in ("force_torque_sensor_broadcaster", "tcp_pose_broadcaster", "passthrough_trajectory")
            and side == "state"
        ):
            continue  # told as a pattern: see the next test
        assert set(names) == set(counted(listed)), side


@of_the_arm
def test_what_is_told_as_a_pattern_is_filled_with_the_names_of_the_cell(case: Case) -> None:
    target = real_target(case)
    joints = [joint.name for joint in target.cell.device("arm").joints]
    passed = {f"{joint}/{state}" for joint in joints for state in ("position", "velocity")}
    assert set(_controller(target, "passthrough_trajectory").state_interfaces) == {
        *passed,
        "arm_speed_scaling/speed_scaling_factor",
    }
    pose = _controller(target, "tcp_pose_broadcaster").state_interfaces
    assert pose == tuple(f"arm_tcp_pose/{p}" for p in ("position.x", "position.y", "position.z")) + tuple(
        f"arm_tcp_pose/orientation.{axis}" for axis in "xyzw"
    )


@of_the_arm
@every_kind
def test_a_kind_is_told_what_the_vendor_s_own_configuration_tells(case: Case, kind: str) -> None:
    target, told = real_target(case), _told(case, kind)
    given = dict(_controller(target, kind).parameters_on("real"))
    declared = told.get("declared_parameters")
    assert declared is None or set(given) <= set(declared)
    for name, value in told["parameters"].items():
        filled = [_filled(item, target) for item in value] if isinstance(value, list) else _filled(value, target)
        if name in ("topic_name", "state_interface_names", "tf", "frame_id"):
            continue  # no parameter of the plugin, or the cell's own choice: one writer of fixed frames
        assert given[name] == (tuple(filled) if isinstance(filled, list) else filled), name


def _filled(value: Any, target: RealTarget) -> Any:
    return value.replace("$(var tf_prefix)", target.prefix) if isinstance(value, str) else value


@of_the_arm
@every_kind
def test_the_policy_grants_a_kind_what_its_node_has(case: Case, kind: str) -> None:
    controller = _controller(real_target(case), kind)
    endpoints = _told(case, kind)["endpoints"]
    enclave = _policy(case)["/ur5e_pick/controller_manager"]
    rights: dict[str, Right] = {
        "service": "reply",
        "publisher": "publish",
        "subscription": "subscribe",
        "action_server": "execute",
    }
    for one in endpoints if isinstance(endpoints, list) else ():
        name = one["name"].replace("<controller>", "~").replace("~", controller.full_name)
        assert enclave.allow(rights[one["kind"]], name), name


@of_the_arm
@pytest.mark.parametrize("kind", _MOVING)
def test_a_kind_that_moves_the_arm_starts_inactive_and_is_let_go_when_the_program_stops(case: Case, kind: str) -> None:
    target = real_target(case)
    controller = _controller(target, kind)
    assert _KINDS[kind] in facts(case.release, "controllers")["spawned"]["inactive"]
    assert controller.targets == ("real",)
    (watch,) = target.yaml("config/bring_up.json")["watches"]
    assert controller.name in watch["controllers"]


@of_the_arm
def test_only_ways_of_commanding_that_the_driver_takes_at_once_are_let_through(case: Case) -> None:
    hardware = real_target(case).cell.device("arm").control.hardware
    assert hardware is not None
    assert hardware.modes is not None
    pairs = facts(case.release, "hardware_interfaces")["modes_that_may_run_together"]["pairs"]
    told = {frozenset(_GPIOS.get(way, way) for way in pair.split("+")) for pair in pairs}
    ours = {frozenset(name.removeprefix("arm_") for name in pair) for pair in hardware.modes.together}
    named = {name.removeprefix("arm_") for name in hardware.modes.names}
    assert ours == {pair for pair in told if pair <= named}


@pytest.mark.parametrize("case", here([case for case in CASES if case.release.device == "franka_fr3"]), ids=str)
def test_the_state_of_an_fr3_is_published_as_its_vendor_publishes_it(case: Case) -> None:
    target = real_target(case)
    controller = _controller(target, "robot_state_broadcaster")
    told = facts(case.release, "controllers")["vendor_bringup"]["active"]["franka_robot_state_broadcaster"]
    assert controller.plugin == told["type"]
    assert controller.command_interfaces == ()
    given = controller.parameters_on("real")
    assert {name: given[name] for name in told["parameters"]} == told["parameters"]
    published = facts(case.release, "nodes")["franka_robot_state_broadcaster"]["publishes"]
    enclave = permissions(target.texts)["/fr3_hand/controller_manager"]
    for name in published:
        assert enclave.allow("publish", name.replace("~", "/arm_state")), name


@pytest.mark.parametrize("case", here([case for case in CASES if case.release.repository == "ros2_kortex"]), ids=str)
def test_faults_of_a_gen3_are_told_and_reset_as_its_vendor_has_it(case: Case) -> None:
    target = real_target(case)
    controller = _controller(target, "reset_fault")
    told = facts(case.release, "controllers")["gen3"]["fault_controller"]
    assert controller.plugin == told["type"]
    assert controller.targets == ("real",)
    assert list(controller.command_interfaces) == told["claims"]
    assert list(controller.state_interfaces) == told["reads"]
    ends = facts(case.release, "nodes")["fault_controller"]
    enclave = permissions(target.texts)[f"/{target.cell.name}/controller_manager"]
    rights: dict[str, Right] = {"publishes": "publish", "services_served": "reply"}
    for key, right in rights.items():
        (name,) = ends[key]
        assert enclave.allow(right, name.replace("~", controller.full_name))
    (watch,) = target.yaml("config/bring_up.json")["watches"]
    (proof,) = watch["while_hold"].values()
    assert (proof["topic"], proof["values"]) == ("/arm_fault/internal_fault", [False])
    assert watch["controllers"] == ["arm_trajectory", "gripper_action"]


@pytest.mark.parametrize("case", here([case for case in CASES if case.release.repository == "ros2_kortex"]), ids=str)
def test_fingers_and_arm_of_one_component_are_driven_by_controllers_of_their_own(case: Case) -> None:
    target = real_target(case)
    told = facts(case.release, "controllers")["gen3"]
    sections = target.yaml("config/controllers.yaml")
    assert sections["arm_trajectory"]["ros__parameters"]["joints"] == told["joint_trajectory_controller"]["joints"]
    assert sections["gripper_action"]["ros__parameters"]["joint"] == told["robotiq_gripper_controller"]["joint"]
    type_ = sections["controller_manager"]["ros__parameters"]["gripper_action"]["type"]
    assert type_ == told["robotiq_gripper_controller"]["type"]


@pytest.mark.parametrize("case", here([case for case in CASES if case.release.repository == "ros2_kortex"]), ids=str)
def test_errors_of_joints_without_an_end_count_the_shorter_way_round(case: Case) -> None:
    # follow_joint_trajectory.md: from the URDF since jazzy, by angle_wraparound on humble.
    told = real_target(case).yaml("config/controllers.yaml")["arm_trajectory"]["ros__parameters"].get("gains", {})
    turning = {joint for joint, gains in told.items() if gains["angle_wraparound"]}
    assert turning == ({f"joint_{n}" for n in (1, 3, 5, 7)} if case.release.distro == "humble" else set())


@of_the_arm
def test_what_reads_the_arm_alone_goes_on_while_the_gripper_is_activated(case: Case) -> None:
    # A broadcaster that is restarted leaves a hole in the record of the arm; joint states are those of both devices.
    steps = {step["name"]: step for step in real_target(case).yaml("config/bring_up.json")["real"]}
    assert steps["observe_gripper_again"]["request"]["controllers"] == ["joint_states"]
    assert "arm_speed" in steps["observe_control"]["request"]["controllers"]
