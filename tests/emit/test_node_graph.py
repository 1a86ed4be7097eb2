"""Where the boxes of the graph of nodes stand: who commands is left of what it commands, and the stop is behind all."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.emit.node_graph import _exchanges, _layers
from tests.cells import CORPUS, graph_of, spec_of


@pytest.mark.parametrize(
    ("spec", "layers"),
    [
        # The task commands the planner, and that the controllers; perception is heard by the task.
        (
            CORPUS / "valid" / "complete.yaml",
            "perception / task / move_group / joint_states arm_trajectory gripper_action / arm gripper camera / "
            "safety_plc",
        ),
        # There is no controller, and no column for any.
        (CORPUS / "valid" / "camera_only.yaml", "perception / camera / safety_plc"),
        (CORPUS / "valid" / "direct_sdk_arm.yaml", "/arm task / move_group / arm / safety_plc"),
        # In the first layer is robot_state_publisher alone, which is heard and not asked.
        (
            spec_of("fr3_hand"),
            " / task / move_group / joint_states arm_trajectory arm_state hand_action / arm hand / safety_relay",
        ),
    ],
    ids=["complete", "a camera alone", "an adapter", "a vendor's node"],
)
def test_boxes_stand_behind_those_that_command_them(spec: Path, layers: str) -> None:
    cell = graph_of(spec).cell
    found = _layers(cell, _exchanges(cell))
    for served in (
        "robot_state_publisher",
        "controller_manager",
        "/hand_gripper",
        "arm_dashboard_client",
        "arm_state_helper",
    ):
        found.pop(served, None)
    meant = {name: at for at, names in enumerate(layers.split(" / ")) for name in names.split()}
    assert {name.strip(): at for name, at in found.items()} == meant
