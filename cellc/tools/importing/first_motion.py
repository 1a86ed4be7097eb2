"""Where a robot goes first: every joint a little way, as far as nothing is touched on the straight way there."""

from __future__ import annotations

from collections.abc import Callable

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.feasibility.feasibility import question_at_hand
from cellc.compiler.feasibility.meshes import mesh_roots
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.tools.importing.chain import Chain, away_of, back_of, home_of

Configuration = tuple[float, ...]


def first_goal(graph: CellGraph | None, group: str, chain: Chain) -> Configuration:
    """Return where the joints of a chain go from home, rad or m.

    Args:
        graph: the cell in which they move; None where it has none.
        group: its planning group of the chain.

    Returns:
        All joints moved where that way is free; else those that can be moved one after the other without closing it,
        each to its farther side or else to the other. All joints where nothing can tell, or none is free.
    """
    wanted = tuple(away_of(joint) for joint in chain.joints)
    free = None if graph is None else _free_way(graph, group, chain)
    if free is None or free(wanted):
        return wanted
    home = chosen = tuple(home_of(joint) for joint in chain.joints)
    for place, joint in enumerate(chain.joints):
        tried = ((*chosen[:place], to, *chosen[place + 1 :]) for to in (wanted[place], back_of(joint)))
        chosen = next((goal for goal in tried if free(goal)), chosen)
    return wanted if chosen == home else chosen


def _free_way(graph: CellGraph, group: str, chain: Chain) -> Callable[[Configuration], bool] | None:
    """Return a check whether the straight path from home to a configuration is free; None where it is not possible."""
    if motion_answer(graph).refused:
        return None
    from cellc.compiler.feasibility.compute import planner_of  # loads the robot library
    from cellc.robot.planning import JointPath

    planner = planner_of(question_at_hand(graph), group, mesh_roots(graph.cell))
    home = tuple(home_of(joint) for joint in chain.joints)
    return lambda goal: isinstance(planner.plan_to_configuration(home, goal, max_iterations=0), JointPath)
