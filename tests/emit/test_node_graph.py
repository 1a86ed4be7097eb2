"""Where the boxes of the graph of nodes stand: who commands is left of what it commands, and the stop is behind all."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.emit.node_graph import Exchange, _depths, _exchanges, _layers
from tests.cells import CORPUS, graph_of, spec_of
from tests.rules.halls import of_managers


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


def test_what_many_publish_for_many_goes_through_a_box_of_its_own(tmp_path: Path) -> None:
    # 12 broadcasters publish for 12 nodes and robot_state_publisher: 156 lines, or 25 through a box.
    (tmp_path / "cell.yaml").write_text(of_managers(12), encoding="utf-8")
    cell = graph_of(tmp_path / "cell.yaml").cell
    (states,) = (exchange for exchange in _exchanges(cell) if "/joint_states" in exchange.names)
    assert (len(states.starts), len(states.ends), states.hub) == (12, 13, "\n/joint_states")
    layers = _layers(cell, _exchanges(cell))
    assert layers[states.hub] == layers[states.ends[0]]


@pytest.mark.parametrize(("starts", "ends", "hub"), [(8, 8, ""), (9, 9, "\n/a"), (1, 99, ""), (99, 5, "\n/a")])
def test_few_arrows_go_straight(starts: int, ends: int, hub: str) -> None:
    names = tuple(f"n{number}" for number in range(starts + ends))
    assert Exchange("topic", names[:starts], names[starts:], False, ("/a", "/b")).hub == hub


def test_a_chain_of_any_length_has_a_layer_for_each_node_and_a_circle_is_cut() -> None:
    chain = {f"n{number}": {f"n{number - 1}"} if number else set[str]() for number in range(3000)}
    assert _depths(chain) == {f"n{number}": number for number in range(3000)}
    assert _depths({"a": {"b"}, "b": {"a"}, "c": {"a", "c"}}) == {"a": 1, "b": 1, "c": 2}
