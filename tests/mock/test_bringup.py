"""The mock executes the artifacts: what is wrong in them keeps the cell from coming up, with the manager's reason."""

from __future__ import annotations

from pathlib import Path

from cellc.mock import MockCell, load
from cellc.mock.result import RehearsalResult


def run_with(folder: Path, file: str, old: str, new: str) -> RehearsalResult:
    """Replace text in a file of the folder by hand, and run."""
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new, 1))
    return load(folder).run("pick_and_place")


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
    stages = {stage.stage: stage for stage in cell.run("cancelled").bringup}
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
    result = load(folder).run("pick_and_place")
    assert result.outcome == "bringup_failure"
    assert "`arm_wrist_4_joint/position` is claimed by `nobody`" in problems(result)
