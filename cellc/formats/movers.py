"""Which nodes ask for motion on their own account, so that a person starts them at the gate before motion."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.interface import InterfaceKind, Node, NodeSource
from cellc.formats.moveit_files import is_planner


def is_mover(cell: Cell, node: Node) -> bool:
    """Tell whether a node of the spec sends goals or commands without being asked.

    One that serves an action itself, such as a planner, acts when it is told to; one with neither moves nothing.
    """
    if node.source is not NodeSource.SPEC or is_planner(node):
        return False
    actions = [one for one in cell.interfaces if one.kind is InterfaceKind.ACTION]
    serves = any(end.node == node.name for action in actions for end in action.sources)
    asks = any(end.node == node.name for action in actions for end in action.sinks)
    commands = any(controller.client == node.name for controller in cell.controllers)
    return (asks or commands) and not serves


def started_by_a_person(cell: Cell, node: Node) -> bool:
    """Tell whether a node runs only from the gate before motion on; a managed mover runs earlier, unactivated."""
    return is_mover(cell, node) and not node.lifecycle


def movers(cell: Cell) -> tuple[Node, ...]:
    """Return the nodes that a person starts or activates before anything moves."""
    return tuple(node for node in cell.nodes if is_mover(cell, node))
