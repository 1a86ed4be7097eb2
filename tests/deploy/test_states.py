"""In gate G4 a program judges the states that robots publish, and the page shows people the commands that read them."""

from __future__ import annotations

import json

import pytest

from tests.cells import built


@pytest.mark.parametrize(
    ("cell", "topic", "option", "passing"),
    [
        # picknik_controllers@main picknik_reset_fault_controller.cpp:91, a Bool; franka_ros2@v3.4.0
        # FrankaRobotState.msg; ur_dashboard_msgs@3.8.0 SafetyMode.msg and RobotMode.msg.
        ("gen3_2f", "/arm_fault/internal_fault", "--field data ", {False}),
        ("fr3_hand", "/arm_state/robot_state", "--field robot_mode ", {1, 2}),
        ("ur5e_pick", "/arm_io/safety_mode", "", {1, 2}),
        ("ur5e_pick", "/arm_io/robot_mode", "", {3, 5}),
    ],
)
def test_state_that_a_robot_publishes_is_judged_in_g4(cell: str, topic: str, option: str, passing: set[int]) -> None:
    texts = built(cell).texts
    readings = json.loads(texts["config/observe.json"])["real"]["readings"]
    (reading,) = [each for each in readings if each["interface"] == topic]
    assert reading["fields"] == [option.removeprefix("--field ").strip() or "mode"]
    assert {reading["values"][name] for name in reading["expected"]["G4"]} == passing
    gate = texts["gates/promotion.md"].split("\n## G4")[1].split("\n## G5")[0]
    assert "the states of devices" in gate
    assert "observe --package" in gate
    assert f"ros2 topic echo --once {option}{topic}" in gate
