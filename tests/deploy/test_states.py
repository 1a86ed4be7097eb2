"""In gate G4 a program judges the states that robots publish, and people those that no topic has."""

from __future__ import annotations

import json

import pytest

from tests.cells import built


@pytest.mark.parametrize(
    ("cell", "topic", "fields", "passing"),
    [
        # picknik_controllers@main picknik_reset_fault_controller.cpp:91, a Bool; franka_msgs/msg/FrankaRobotState.msg of
        # franka_ros2@v3.4.0; ur_dashboard_msgs/msg/SafetyMode.msg and RobotMode.msg of 3.8.0.
        ("gen3_2f", "/arm_fault/internal_fault", ["data"], {False}),
        ("fr3_hand", "/arm_state/robot_state", ["robot_mode"], {1, 2}),
        ("ur5e_pick", "/arm_io/safety_mode", ["mode"], {1, 2}),
        ("ur5e_pick", "/arm_io/robot_mode", ["mode"], {3, 5}),
    ],
)
def test_state_that_a_robot_publishes_is_judged_in_g4(
    cell: str, topic: str, fields: list[str], passing: set[int]
) -> None:
    texts = built(cell).texts
    readings = json.loads(texts["config/observe.json"])["real"]["readings"]
    (reading,) = [each for each in readings if each["interface"] == topic]
    assert reading["fields"] == fields
    assert {reading["values"][name] for name in reading["expected"]["G4"]} == passing
    gate = texts["gates/promotion.md"].split("\n## G4")[1].split("\n## G5")[0]
    assert "the states of devices" in gate
    assert "observe --package" in gate
    assert "Check that arm reports" not in gate


def test_state_that_no_topic_has_is_looked_at_by_people_in_g4() -> None:
    gate = built("fr3_hand").texts["gates/promotion.md"].split("\n## G4")[1].split("\n## G5")[0]
    assert "At arm, check that it is not in state emergency_stop, which no topic reports." in gate
