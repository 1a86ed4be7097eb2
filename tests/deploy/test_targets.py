"""A hand that a controller closes on the mock and its vendor's node on real hardware: what is said of which target."""

from __future__ import annotations

from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.labels import claim_facts
from cellc.compiler.deploy.recording import recorded_topics
from tests.cells import built


def _cell() -> Cell:
    return built("fr3_hand").graph.cell


def _claim(controller: str) -> tuple[str, str]:
    """Return what is claimed, and what it reaches on real hardware and when it is active."""
    (manager,) = _cell().managers
    (one,) = (one for one in manager.controllers if one.name == controller)
    claims, _, _, ends = claim_facts(_cell(), manager, one, one.all_claims, _cell().device(one.device or ""))
    return claims, ends.partition("; architecture")[0]


def test_claim_of_a_controller_of_the_mock_alone_reaches_no_hardware() -> None:
    assert _claim("hand_action") == (
        "fr3_finger_joint1/position",
        "only on the mock, through mock_components/GenericSystem; active from startup",
    )


def test_claim_that_differs_between_the_targets_is_told_of_each() -> None:
    position, effort = (
        ", ".join(f"fr3_joint{number}/{kind}" for number in range(1, 8)) for kind in ("position", "effort")
    )
    claims, ends = _claim("arm_trajectory")
    assert claims == f"{position} on the mock; {effort} on real hardware"
    assert ends == "through franka_hardware/FrankaHardwareInterface; active from startup"


def test_controller_of_real_hardware_alone_goes_through_its_driver() -> None:
    assert _claim("arm_state")[1] == "through franka_hardware/FrankaHardwareInterface; active from startup"


def test_what_the_mock_alone_has_is_not_recorded() -> None:
    cell = _cell()
    recorded = recorded_topics(cell)
    actions = {name.partition("/_action/")[0] for name in recorded if "/_action/" in name}
    assert actions == {"/move_action", "/arm_trajectory/follow_joint_trajectory", "/hand_gripper/gripper_action"}
    assert {f"{action}/_action/{part}" for action in actions for part in ("feedback", "status")} <= set(recorded)
    assert {"/arm_state/robot_state", "/joint_states", "/tf", "/tf_static", "/diagnostics"} <= set(recorded)
    assert "/hand_action/gripper_cmd/_action/status" not in recorded
    assert (recorded["/tf_static"].durability, recorded["/tf"].durability) == ("transient_local", "volatile")
