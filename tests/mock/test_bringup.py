"""The mock executes the artifacts: what is wrong in them keeps the cell from coming up, with the manager's reason."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cellc.mock import MockCell, load
from cellc.mock.errors import MockError
from cellc.mock.result import RehearsalResult


def run_with(folder: Path, file: str, old: str, new: str) -> RehearsalResult:
    """Replace text in a file of the folder by hand, and run."""
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new, 1))
    return load(folder, edited=True).run("pick_and_place")


def problems(result: RehearsalResult) -> str:
    return "; ".join(problem for stage in result.bringup for problem in stage.problems)


def test_wrong_joint_in_controllers_yaml_fails_with_the_reason_of_the_manager(folder: Path) -> None:
    result = run_with(folder, "config/controllers.yaml", "- arm_elbow_joint", "- arm_elbw_joint")
    assert result.outcome == "bringup_failure"
    assert not result.passed
    assert result.attempts == ()
    assert "arm_elbw_joint/position" in problems(result)
    assert result.bringup[-1].stage == "claim"


def test_update_rate_with_a_decimal_point_ends_the_manager(folder: Path) -> None:
    result = run_with(folder, "config/controllers.yaml", "update_rate: 500", "update_rate: 500.0")
    assert result.outcome == "bringup_failure"
    assert "expected [integer] got [double]" in problems(result)


def test_unknown_controller_type_fails_in_configure(folder: Path) -> None:
    plugin = "joint_state_broadcaster/JointStateBroadcaster"
    result = run_with(folder, "config/controllers.yaml", plugin, "joint_state_broadcaster/Missing")
    assert result.outcome == "bringup_failure"
    assert result.bringup[-1].stage == "configure"


def test_claims_stand_in_the_evidence(cell: MockCell) -> None:
    stages = {stage.stage: stage for stage in cell.run("canceled").bringup}
    assert list(stages) == ["discover", "configure", "observe", "claim"]
    assert "`arm_elbow_joint/position` is claimed by `arm_trajectory`" in stages["claim"].facts
    assert len(stages["claim"].facts) == 7  # six joints of the arm and one of the gripper


def test_claim_that_differs_from_the_contract_is_a_problem(folder: Path) -> None:
    contract = folder / "contract.json"
    text = contract.read_text()
    wanted = '"arm_wrist_3_joint/position"'
    claims = text.index('"command_interfaces"', text.index('"arm_trajectory": {'))
    at = text.index(wanted, claims)
    contract.write_text(text[:at] + '"arm_wrist_4_joint/position"' + text[at + len(wanted) :])
    result = load(folder, edited=True).run("pick_and_place")
    assert result.outcome == "bringup_failure"
    assert "`arm_wrist_4_joint/position` must be claimed by `arm_trajectory`, got no controller" in problems(result)


NEVER: list[tuple[str, dict[str, Any], str]] = [
    ("node", {"node": "/nobody"}, "no node /nobody"),
    ("lifecycle", {"node": "/nobody", "state": "active"}, "no node /nobody"),
    ("lifecycle", {"node": "/task", "state": "active"}, "/task must be active, got unconfigured"),
    ("controller", {"manager": "/nobody", "controller": "arm_io", "state": "active"}, "no manager /nobody"),
    (
        "controller",
        {"manager": "/controller_manager", "controller": "nobody", "state": "active"},
        "controller nobody must be active, got not loaded",
    ),
    (
        "hardware",
        {"manager": "/controller_manager", "component": "arm_hardware", "state": "inactive"},
        "hardware arm_hardware must be inactive, got active",
    ),
    ("topic", {"topic": "/x", "type": "std_msgs/msg/Bool"}, "no message on /x"),
    (
        "topic",
        {"topic": "/joint_states", "type": "std_msgs/msg/Bool"},
        "/joint_states must be std_msgs/msg/Bool, got sensor_msgs/msg/JointState",
    ),
    ("action", {"action": "/object_pose"}, "no server for /object_pose"),
    ("transform", {"parent": "world", "child": "nobody"}, "no transform from world to nobody"),
    ("mock", {"node": "/nobody", "plugins": ["mock_components/GenericSystem"]}, "no node /nobody with a description"),
    (
        "mock",
        {"node": "/robot_state_publisher", "plugins": ["mine/Sim"]},
        "/robot_state_publisher must describe only mine/Sim, got mock_components/GenericSystem",
    ),
]


def plan_with(folder: Path, step: str, change: Callable[[dict[str, Any]], None]) -> RehearsalResult:
    """Change one step of the mock in the plan, and run."""
    file = folder / "config/bring_up.json"
    plan = json.loads(file.read_text())
    change(next(one for one in plan["mock"] if one["name"] == step))
    file.write_text(json.dumps(plan))
    return load(folder, edited=True).run("pick_and_place")


@pytest.mark.parametrize(("kind", "fields", "missing"), NEVER, ids=[f"{one[0]}-{one[2]}" for one in NEVER])
def test_what_can_never_show_stops_the_plan_at_its_step(
    kind: str, fields: dict[str, Any], missing: str, folder: Path
) -> None:
    result = plan_with(folder, "claim_control", lambda step: step["proof"].append({"kind": kind, **fields}))
    assert result.outcome == "bringup_failure"
    assert problems(result) == f"step `claim_control`: {missing}"


@pytest.mark.parametrize("step", ["configure_perception", "activate_gripper", "claim_control", "move"])
def test_a_step_waits_for_every_proof_of_a_list_that_it_names(step: str, folder: Path) -> None:
    file = folder / "config/bring_up.json"
    plan = json.loads(file.read_text())
    plan["shared"]["mock"]["mine"] = [{"kind": "node", "node": "/task"}, {"kind": "action", "action": "/x"}]
    next(one for one in plan["mock"] if one["name"] == step)["proof"][0] = {"kind": "shared", "list": "mine"}
    file.write_text(json.dumps(plan))
    assert problems(load(folder, edited=True).run("pick_and_place")) == f"step `{step}`: no server for /x"


def test_a_step_of_any_target_names_a_list_that_its_target_has(folder: Path) -> None:
    file = folder / "config/bring_up.json"
    plan = json.loads(file.read_text())
    del plan["shared"]["real"]["every_step"]
    file.write_text(json.dumps(plan))
    with pytest.raises(MockError) as refused:
        load(folder, edited=True)
    assert "step configure_perception must wait for lists of `shared.real`, got every_step" in str(refused.value)


def test_an_effect_that_does_not_show_stops_the_plan_after_its_request(folder: Path) -> None:
    never = {"kind": "topic", "topic": "/x", "type": "std_msgs/msg/Bool"}
    told = problems(plan_with(folder, "activate_gripper", lambda step: step["effect"].append(never)))
    assert told == "step `activate_gripper`: no message on /x"


@pytest.mark.parametrize("step", ["configure_perception", "activate_gripper", "move"])
def test_every_phase_of_the_plan_is_judged(step: str, folder: Path) -> None:
    never = {"kind": "topic", "topic": "/x", "type": "std_msgs/msg/Bool"}
    result = plan_with(folder, step, lambda one: one["proof"].append(never))
    assert problems(result) == f"step `{step}`: no message on /x"


def test_steps_in_another_order_do_not_find_their_proof(folder: Path) -> None:
    file = folder / "config/bring_up.json"
    plan = json.loads(file.read_text())
    plan["mock"].insert(0, plan["mock"].pop([one["name"] for one in plan["mock"]].index("activate_perception")))
    file.write_text(json.dumps(plan))
    told = problems(load(folder, edited=True).run("pick_and_place"))
    assert told == "step `activate_perception`: /perception must be inactive, got unconfigured"


def test_a_deadline_that_is_too_short_for_its_effect_fails(folder: Path) -> None:
    def change(step: dict[str, Any]) -> None:
        step["proof"].append({"kind": "topic", "topic": "/joint_states", "type": "sensor_msgs/msg/JointState"})
        step["deadline_s"] = 1e-9

    assert (
        problems(plan_with(folder, "observe_control", change)) == "step `observe_control`: no message on /joint_states"
    )


def test_what_the_mock_cannot_judge_stands_in_the_evidence(folder: Path) -> None:
    said = {"topic": "/arm_io/robot_program_running", "type": "std_msgs/msg/Bool", "field": "data", "values": [True]}
    result = plan_with(folder, "move", lambda step: step["proof"].append({"kind": "topic", **said}))
    assert result.passed
    facts = [fact for stage in result.bringup for fact in stage.facts]
    assert "step `move` believes what `/arm_io/robot_program_running` says in `data`" in facts
