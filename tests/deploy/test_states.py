"""The gates read the state of a robot by a command where the robot publishes it."""

from __future__ import annotations

import pytest

from tests.cells import built


@pytest.mark.parametrize(
    ("cell", "command"),
    [
        ("gen3_2f", "ros2 topic echo --once --field data /arm_fault/internal_fault"),
        ("fr3_hand", "ros2 topic echo --once --field robot_mode /arm_state/robot_state"),
        ("fr3_hand", "ros2 topic echo --once --field current_errors /arm_state/robot_state"),
        ("ur5e_pick", "ros2 topic echo --once /arm_io/safety_mode"),
    ],
)
def test_state_that_a_robot_publishes_is_read_in_g4(cell: str, command: str) -> None:
    gate = built(cell).texts["gates/promotion.md"].split("\n## G4")[1].split("\n## G5")[0]
    assert command in gate
