"""What nodes are called, and which of them plans."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cellc.compiler.cell.interface import Node, NodeSource, node_labels
from cellc.contract.diagnostics import Span

_TASK = Node(
    name="task",
    path=("nodes", "task"),
    span=Span("cell.yaml", 1, 1, 1, 5),
    source=NodeSource.SPEC,
    package="own",
    executable="run",
    host="pc",
    owner="us",
    parameters={},
)


@pytest.mark.parametrize(
    ("package", "executable", "plans"),
    [
        ("moveit_ros_move_group", "move_group", True),
        ("moveit_ros_move_group", "list_move_group_capabilities", False),  # the package has it, too
        ("own", "move_group", False),
        ("own", "run", False),
    ],
)
def test_planner_is_one_program_of_one_package(package: str, executable: str, plans: bool) -> None:
    assert replace(_TASK, package=package, executable=executable).is_planner is plans


def test_label_is_the_bare_name_where_nobody_shares_it() -> None:
    left, right = (replace(_TASK, namespace=f"/{side}") for side in ("left", "right"))
    other = replace(left, name="other")
    assert node_labels(()) == ()
    assert node_labels((left, other)) == ("task", "other")
    assert node_labels((left, other, right)) == ("/left/task", "other", "/right/task")
    assert node_labels((_TASK, left)) == ("/task", "/left/task")
