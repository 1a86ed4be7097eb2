"""Rules on whether an arm gets where it is sent."""

from __future__ import annotations

from itertools import pairwise

from cellc.compiler.feasibility import HoldingAnswer, motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS, KNOWN_POSES, in_the_chain
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule

_LEAST_SHARE = 0.02


@rule(Severity.WARNING, assumes=KNOWN_GOALS)
def goal_near_joint_limit(graph: CellGraph) -> Findings:
    """Yield goals that leave one joint less than its share of room."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.limit_joint and goal.limit_share < _LEAST_SHARE:
            message = (
                f"goal `{goal.name}` must leave `{goal.limit_joint}` {_LEAST_SHARE:.0%} of its range to the limit, "
                f"got {goal.limit_share:.1%} ({goal.limit_distance:.2g})"
            )
            related = in_the_chain(graph, goal.name)
            yield found(graph, (*paths[goal.name], "frame"), message, related=related)


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def infeasible_approach(graph: CellGraph) -> Findings:
    """Yield goals that are reached, but not along their approach."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.approach_failure:
            message = f"no straight line leads to goal `{goal.name}`: {goal.approach_failure}"
            related = in_the_chain(graph, goal.name)
            yield found(graph, (*paths[goal.name], "approach"), message, related=related)


@rule(Severity.WARNING, assumes=(*KNOWN_POSES, "negative-mass", "payload-above-limit"))
def joint_too_weak(graph: CellGraph) -> Findings:
    """Yield joints that must hold more than their limit of effort, each where it is worst."""
    owners = {joint.name: (device, joint) for device in graph.cell.devices for joint in device.joints}
    for held in motion_answer(graph).holding:
        device, joint = owners[held.joint]
        if joint.effort is None or held.effort <= joint.effort:
            continue
        path = (*device.path, "payload", "mass") if device.robot.payload is not None else device.path
        unit = "N" if joint.type == "prismatic" else "Nm"
        where = f"in `{held.posture}`" if held.posture else "at the start of the cell"
        where = f"on the way from {where.removeprefix('in ')} to `{held.towards}`" if held.towards else where
        message = f"`{held.joint}` can give {joint.effort:g} {unit} but must hold {held.effort:.3g} {unit} {where}"
        related = tuple(Related("the worst place", graph.cell.locate(*place)) for place in _places(graph, held))
        yield found(graph, path, message, related=related)


def _places(graph: CellGraph, held: HoldingAnswer) -> list[YamlPath]:
    posed = [*graph.cell.poses, *graph.cell.goals]
    return [posture.path for posture in posed if posture.name == held.posture][:1]


_LEAST_AT_GOAL = 0.05


@rule(Severity.WARNING, assumes=KNOWN_GOALS)
def near_singular_goal(graph: CellGraph) -> Findings:
    """Yield goals below the least singular value that leaves room."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        least = goal.min_singular_value
        if least is not None and least < _LEAST_AT_GOAL:
            message = (
                f"the least singular value at goal `{goal.name}` must be at least {_LEAST_AT_GOAL:g}, got {least:.2g}"
            )
            related = in_the_chain(graph, goal.name)
            yield found(graph, (*paths[goal.name], "frame"), message, related=related)


_LEAST_IN_POSE = 0.02


@rule(Severity.WARNING, assumes=KNOWN_POSES)
def near_singular_pose(graph: CellGraph) -> Findings:
    """Yield poses from which a rehearsal goes to a goal and in which the tip can lose a direction."""
    groups = {goal.name: goal.group for goal in graph.cell.goals}
    starts = {
        (before, groups[after])
        for rehearsal in graph.cell.rehearsals
        for before, after in pairwise(step.name for step in rehearsal.steps if step.kind == "move")
        if after in groups
    }
    paths = {(pose.name, pose.group): pose.path for pose in graph.cell.poses}
    for pose in motion_answer(graph).poses:
        for group, least in pose.least:
            if least < _LEAST_IN_POSE and (pose.name, group) in starts:
                message = f"the least singular value in pose `{pose.name}`, from which `{group}` goes to a goal,"
                message += f" must be at least {_LEAST_IN_POSE:g}, got {least:.2g}"
                yield found(graph, paths[pose.name, group], message)


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def singular_goal(graph: CellGraph) -> Findings:
    """Yield goals whose every solution is singular."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.failure == "singular":
            message = f"goal `{goal.name}` can be reached only in a singularity: {goal.detail}"
            yield found(graph, (*paths[goal.name], "frame"), message, related=in_the_chain(graph, goal.name))


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def unreachable_goal(graph: CellGraph) -> Findings:
    """Yield goals for which the search ended away from the target."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.failure in ("no_ik_solution", "out_of_limits"):
            message = f"no joint positions were found for goal `{goal.name}`: {goal.detail}"
            yield found(graph, (*paths[goal.name], "frame"), message, related=in_the_chain(graph, goal.name))
