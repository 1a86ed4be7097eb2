"""Arms that the library of their vendor drives: the node that does it, and what people and launch files are told."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree.ElementTree import fromstring

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.bringup import bring_up
from cellc.compiler.deploy.deployment import plan_deployment
from cellc.compiler.deploy.first_goal import first_goals
from cellc.compiler.emit import moveit, parameters
from cellc.compiler.emit.launch import launch
from cellc.compiler.emit.security import policy
from cellc.compiler.graph.cell_graph import build_graph
from cellc.contract.entities import TARGETS
from tests.cells import catalog_facts, linked, linking, spec_of, spec_text, written
from tests.consumers.permissions import permissions
from tests.foreign_yaml import safe_load

_EMITTERS = (launch.emit, parameters.emit, policy.emit, moveit.emit)


@pytest.fixture(name="cell", scope="module")
def cell_fixture() -> Cell:
    """Return the cell of an arm behind an adapter, and a gripper that ros2_control drives."""
    return linked(spec_of("hybrid_sdk"))


@pytest.fixture(name="texts", scope="module")
def texts_fixture(cell: Cell) -> dict[str, str]:
    """Return what is launched, told and granted."""
    graph = build_graph(cell)
    plan = plan_deployment(graph)
    return {artifact.path: artifact.text for emit in _EMITTERS for artifact in emit(graph, plan)}


def test_an_adapter_has_a_node_that_is_started_on_the_real_target_alone(texts: dict[str, str]) -> None:
    nodes = fromstring(texts["launch/control_pc.launch.xml"]).findall("node")
    (node,) = (node for node in nodes if node.get("name") == "arm")
    assert (node.get("pkg"), node.get("exec")) == ("cell_drivers", "fr3_loop")
    assert "real" in node.get("if", "")
    assert node.get("ros_args") == "--enclave /hybrid_sdk/arm"


def test_an_adapter_may_say_its_states_and_take_its_goals_and_nothing_else_of_the_cell(texts: dict[str, str]) -> None:
    may = permissions(texts)["/hybrid_sdk/arm"]
    assert may.allow("publish", "/joint_states")
    assert may.allow("execute", "/arm/follow_joint_trajectory")
    assert not may.allow("call", "/move_action")
    assert not may.allow("request", "/controller_manager/switch_controller")


def test_an_adapter_is_told_what_the_spec_says_of_it_in_si(texts: dict[str, str]) -> None:
    told = safe_load(texts["config/drivers.yaml"])["arm"]["ros__parameters"]
    assert told == {
        "address": "172.16.0.2",
        "joints": [f"fr3_joint{number}" for number in range(1, 8)],
        "command_timeout": 0.02,
        "stop_time": 0.2,
        "goal_time": 1.0,
        "path_tolerance": 0.1,
    }


def test_move_group_asks_the_adapter_by_its_action(texts: dict[str, str]) -> None:
    # moveit_simple_controller_manager joins name and action_ns to the name of the action.
    told = safe_load(texts["config/moveit/controllers.yaml"])["/**"]["ros__parameters"][
        "moveit_simple_controller_manager"
    ]
    assert told["controller_names"] == ["arm"]
    assert (told["arm"]["action_ns"], told["arm"]["type"]) == ("follow_joint_trajectory", "FollowJointTrajectory")
    assert told["arm"]["joints"] == [f"fr3_joint{number}" for number in range(1, 8)]


def test_the_mock_waits_for_no_transform_over_joints_that_nobody_drives_there(cell: Cell) -> None:
    waited: dict[str, set[str]] = {target: set() for target in TARGETS}
    for target in TARGETS:
        proofs = (proof for step in bring_up(cell).proven_steps(target) for proof in step.proof)
        waited[target] |= {proof.child for proof in proofs if proof.kind == "transform"}
    assert waited == {"mock": set(), "real": {"tcp"}}


def test_what_asks_for_motion_waits_for_the_action_of_an_adapter_on_the_real_target(cell: Cell) -> None:
    for target in TARGETS:
        (move,) = (step for step in bring_up(cell).steps(target) if step.phase == "move")
        actions = {proof.action for proof in move.proof if proof.kind == "action"}
        assert ("/arm/follow_joint_trajectory" in actions) is (target == "real")


def test_the_first_goal_is_sent_to_the_adapter_of_the_joint(cell: Cell) -> None:
    (goal,) = first_goals(cell)
    assert (goal.action, goal.topic, goal.moves[0]) == ("/arm/follow_joint_trajectory", "/joint_states", "fr3_joint7")
    assert [joint.name for joint in goal.joints] == [f"fr3_joint{number}" for number in range(1, 8)]


# What franka_ros2 alone has, and ros2_control: neither runs for an arm behind an adapter.
_OF_THE_DRIVER = re.compile(
    r"ros2 service|service_server|action_server|hardware component|claim(?!.launch)|franka_msgs"
)


def test_nobody_is_told_of_a_driver_that_does_not_run(cell: Cell) -> None:
    arm = cell.device("arm")
    steps = [step.does for step in arm.procedures.commissioning] + [
        step for way in arm.procedures.safety.recovery for step in way.steps
    ]
    assert len(steps) > 20
    assert [step for step in steps if _OF_THE_DRIVER.search(step)] == []


def test_a_driver_s_arm_has_no_step_of_an_adapter() -> None:
    arm = linked(spec_of("fr3_hand")).device("arm")
    steps = [step.does for step in arm.procedures.commissioning] + [
        step for way in arm.procedures.safety.recovery for step in way.steps
    ]
    assert [step for step in steps if re.search(r"\badapter\b", step)] == []
    assert any("service_server" in step for step in steps)


def test_every_way_back_of_an_fr3_exists_for_its_driver_and_for_an_adapter() -> None:
    ways = catalog_facts("franka_fr3")["safety"]["recovery"]
    states = {by: [way["state"] for way in ways if way.get("by", by) == by] for by in ("driver", "adapter")}
    assert states["driver"] == states["adapter"]
    assert len(set(states["driver"])) == len(states["driver"]) == 6


def test_the_stop_reaches_an_arm_behind_an_adapter(cell: Cell) -> None:
    assert all(device.control.is_driven for device in cell.devices)


def test_what_is_no_program_is_refused_at_its_line(tmp_path: Path) -> None:
    text = spec_text("hybrid_sdk").replace("run: cell_drivers/fr3_loop", "run: fr3_loop")
    (found,) = linking(written(tmp_path, text)).diagnostics
    assert (found.code, found.yaml_path) == ("not-an-executable", ("devices", "arm", "adapter", "run"))


def test_the_nodes_of_a_vendor_s_driver_are_not_started_beside_an_adapter(tmp_path: Path) -> None:
    text = spec_text("hybrid_sdk")
    text = re.sub(r"(?s)    model: franka_fr3\n    prefix: \"\"\n", '    model: ur5e\n    prefix: ""\n', text)
    text = re.sub(r"    description: franka_description 2.8.0\n", "    description: ur_description 3.5.1\n", text)
    text = text.replace("driver: franka_ros2 3.4.0", "driver: ur_robot_driver 3.8.0").replace(
        "arm/fr3_joint7", "arm/wrist_3_joint"
    )
    text = re.sub(r"home: \{arm: .*\}", "home: {arm: 0 -90 90 -90 -90 0 deg}", text).replace("arm/flange", "arm/tool0")
    outcome = linking(written(tmp_path, text))
    assert outcome.value is not None, outcome.diagnostics
    assert [node.full_name for node in outcome.value.nodes if node.device == "arm"] == ["/arm"]
    (adapted,) = outcome.value.adapters
    assert adapted.node == "/arm"


def test_a_controller_runs_where_something_moves_each_of_its_joints() -> None:
    # The rail has no plugin on the real target, the arm has: one controller has joints of both.
    cell = linked(spec_of("rail_arm"))
    targets = {controller.name: controller.targets for controller in cell.controllers}
    assert targets == {
        "joint_states": ("mock", "real"),
        "trajectory": ("mock",),
        "arm_speed": ("mock", "real"),
        "arm_io": ("real",),
    }


def test_procedures_are_sorted_by_what_drives_a_device_also_where_no_adapter_is() -> None:
    cell = linked(spec_of("fr3_hand"))
    assert {step.by for device in cell.devices for step in device.procedures.commissioning} == {None, "driver"}
    assert {way.by for device in cell.devices for way in device.procedures.safety.recovery} == {None, "driver"}
