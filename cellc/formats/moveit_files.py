"""Which MoveIt files the package has, and which node reads them."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.interface import Node

JOINT_LIMITS = "config/joint_limits.yaml"
PARAMETER_FILES = (
    "config/moveit/kinematics.yaml",
    JOINT_LIMITS,
    "config/moveit/cartesian_limits.yaml",
    "config/moveit/planning_pipelines.yaml",
    "config/moveit/controllers.yaml",
    "config/moveit/trajectory_execution.yaml",
    "config/moveit/planning_scene.yaml",
)
"""In the order in which move_group is given them."""


def semantic_file(cell: Cell) -> str:
    """Return the path of the SRDF."""
    return f"config/moveit/{cell.name}.srdf"


def plans(cell: Cell) -> bool:
    """Tell whether the cell has what MoveIt plans for and the node that does it; otherwise nobody reads its files."""
    return bool(cell.groups) and any(is_planner(node) for node in cell.nodes)


def is_planner(node: Node) -> bool:
    """Tell whether a node is MoveIt's move_group, which reads these files."""
    return node.package == "moveit_ros_move_group" and node.executable == "move_group"
