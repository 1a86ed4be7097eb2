"""Controllers of one name under two managers, nodes in namespaces, and what moves a device on real hardware."""

from __future__ import annotations

from pathlib import Path

from cellc.compiler.cell.cell import Cell
from tests.cells import ROOT, linking, written

TWO_ARMS = ROOT / "tests" / "consumers" / "two_arms.yaml"
HEARD = """
interfaces:
  /left/arm_trajectory/controller_state:
    topic: control_msgs/msg/JointTrajectoryControllerState
    from: {source}
    to: left_task
"""


def _linked(folder: Path, text: str) -> tuple[Cell | None, list[str]]:
    outcome = linking(written(folder, text))
    return outcome.value, [f"{one.code}: {one.help}" for one in outcome.diagnostics]


def _heard_from(source: str) -> str:
    return TWO_ARMS.read_text(encoding="utf-8").replace("\ninterfaces:\n", HEARD.format(source=source), 1)


def test_name_of_two_controllers_is_ambiguous(tmp_path: Path) -> None:
    _, problems = _linked(tmp_path, _heard_from("arm_trajectory"))
    assert problems == ["ambiguous-node: write `/left/arm_trajectory` or `/right/arm_trajectory`"]


def test_full_name_tells_which_of_two_controllers_is_meant(tmp_path: Path) -> None:
    cell, problems = _linked(tmp_path, _heard_from("/right/arm_trajectory"))
    assert problems == []
    assert cell is not None
    (topic,) = (one for one in cell.interfaces if one.name == "/left/arm_trajectory/controller_state")
    assert [end.full_name for end in topic.sources] == ["/right/arm_trajectory"]


def test_node_stands_at_its_interfaces_under_its_namespace(tmp_path: Path) -> None:
    text = TWO_ARMS.read_text(encoding="utf-8").replace("  left_task: {", "  left_task: {namespace: /left, ", 1)
    cell, problems = _linked(tmp_path, text)
    assert problems == []
    assert cell is not None
    (action,) = (one for one in cell.interfaces if one.name == "/left/gripper_action/gripper_cmd")
    assert [(end.node, end.full_name) for end in action.sinks] == [("left_task", "/left/left_task")]


def test_ends_of_a_cell_have_names_of_their_own(tmp_path: Path) -> None:
    cell, _ = _linked(tmp_path, TWO_ARMS.read_text(encoding="utf-8"))
    assert cell is not None
    ends = {(end.node, end.full_name) for one in cell.interfaces for end in (*one.sources, *one.sinks)}
    assert len({node for node, _ in ends}) == len({full for _, full in ends}) == len(ends)
