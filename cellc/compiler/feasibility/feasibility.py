"""Which pairs of links need no collision check, and what named poses and goals of a cell lead to.

Both are computed by the planner and kept in the cache. The planner is imported where an answer has to be computed.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from cellc.compiler.feasibility.answers import DisabledAnswer, DisabledLinks, MotionAnswer
from cellc.compiler.feasibility.meshes import mesh_contents, mesh_faults, mesh_roots, spec_of, with_shapes_at_hand
from cellc.compiler.feasibility.parts import pairs_together, parts_of, standing_part, together
from cellc.compiler.feasibility.question import MotionQuestion, motion_question, shapes_and_joints
from cellc.compiler.feasibility.reach import reach_of
from cellc.compiler.feasibility.touching_links import touching_links
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.limits import Budget, limits
from cellc.contract.printing import stage
from cellc.contract.store.cache import recall
from cellc.robot.description.meshes import MESH_NOT_FOUND

ALLOWED = "user"
"""The word of MoveIt's Setup Assistant for a pair that a person, and no sampling, takes out."""
ROBOT_PAIRS = "robot-pairs"
_Answer = TypeVar("_Answer", DisabledAnswer, MotionAnswer)


def disabled_links(graph: CellGraph) -> DisabledAnswer:
    """Return the pairs with their reasons, for the SRDF and the contract.

    Where the planner refuses the description, these are the pairs that follow from the tree alone; so are those of
    links whose meshes are not here.
    """
    return graph.once(_with_allowed)


def meeting_links(graph: CellGraph, pairs: tuple[tuple[str, str], ...]) -> tuple[DisabledLinks, ...]:
    """Return those of some pairs of links that meet in postures of their joints; ``reason`` is in how many percent.

    Nothing of a description that the planner refuses, and of a pair that meets with all joints at zero.
    """
    if not pairs:
        return ()
    met = tuple(found for part in parts_of(graph) for found in _meeting(part, pairs))
    return tuple(sorted(met))


def _meeting(graph: CellGraph, asked: tuple[tuple[str, str], ...]) -> tuple[DisabledLinks, ...]:
    links = {part.link.name for part in graph.model.links()}
    pairs = tuple(pair for pair in asked if links.issuperset(pair))
    if not pairs or _refused(graph):
        return ()
    urdf = with_shapes_at_hand(graph.once(shapes_and_joints), graph)
    question = f"{urdf}\0{pairs!r}"
    roots = mesh_roots(graph.cell)
    return _kept("meeting", question, graph, DisabledAnswer, lambda: _met(urdf, pairs, roots)).pairs


def _met(urdf: str, pairs: tuple[tuple[str, str], ...], roots: tuple[Path, ...]) -> DisabledAnswer:
    from cellc.compiler.feasibility.compute import sample_meetings

    stage("pairs of links that are not looked at")
    return sample_meetings(urdf, pairs, roots)


def motion_answer(graph: CellGraph) -> MotionAnswer:
    """Return what poses and goals lead to; an empty answer where the cell has no group to move."""
    return graph.once(_motion) if graph.cell.groups else MotionAnswer()


def _with_allowed(graph: CellGraph) -> DisabledAnswer:
    answer = _disabled(graph)
    known = {frozenset((pair.first, pair.second)) for pair in answer.pairs}
    allowed = {
        DisabledLinks(min(pair), max(pair), ALLOWED)
        for device in graph.cell.devices
        for pair in device.body.allowed_collisions
        if frozenset(pair) not in known
    }
    return replace(answer, pairs=tuple(sorted({*answer.pairs, *allowed}))) if allowed else answer


def _disabled(graph: CellGraph) -> DisabledAnswer:
    budget = _budget()
    answers = [_disabled_in(part, budget) for part in parts_of(graph)]
    return answers[0] if len(answers) == 1 else pairs_together(answers, graph.once(_standing))


def _disabled_in(graph: CellGraph, budget: Budget) -> DisabledAnswer:
    if refused := _refused(graph):
        return DisabledAnswer(_touching(graph), 0, *refused)
    urdf = with_shapes_at_hand(whole := graph.once(shapes_and_joints), graph)
    answer = _kept("disabled", urdf, graph, DisabledAnswer, lambda: _sampled(urdf, mesh_roots(graph.cell), budget))
    if answer.refused:
        return DisabledAnswer(_touching(graph), 0, answer.refused, answer.limit)
    return answer if urdf == whole else replace(answer, pairs=_joined(answer.pairs, _touching(graph)))


def _joined(sampled: tuple[DisabledLinks, ...], touching: tuple[DisabledLinks, ...]) -> tuple[DisabledLinks, ...]:
    """Add the pairs of links whose shapes are not there, and which others may know."""
    known = {(pair.first, pair.second) for pair in sampled}
    return tuple(sorted((*sampled, *(pair for pair in touching if (pair.first, pair.second) not in known))))


def _refused(graph: CellGraph) -> tuple[str, str] | None:
    """Return why the shapes are not looked at, and the limit that they are beyond if it is one; None where they are."""
    if fault := _unusable(graph):
        return fault, ""
    shapes = len(graph.cell.scene) + sum(len(part.link.collisions) for part in graph.model.links())
    pairs, most = shapes * (shapes - 1) // 2, limits().robot_pairs
    if pairs <= most:
        return None
    return f"the {shapes} collision shapes make {pairs} pairs, and must make at most {most}", ROBOT_PAIRS


def _unusable(graph: CellGraph) -> str:
    """Return why a mesh that is there cannot be used; empty where all can."""
    return next((fault.message for fault in mesh_faults(graph) if fault.code != MESH_NOT_FOUND), "")


def _touching(graph: CellGraph) -> tuple[DisabledLinks, ...]:
    pairs = (
        DisabledLinks(min(first, second), max(first, second), reason.lower())
        for first, second, reason in touching_links(graph.cell)
    )
    return tuple(sorted(pairs))


def _sampled(urdf: str, roots: tuple[Path, ...], budget: Budget) -> DisabledAnswer:
    from cellc.compiler.feasibility.compute import sample_pairs

    stage("pairs of links that may touch")
    return sample_pairs(urdf, roots, budget)


def _standing(graph: CellGraph) -> DisabledAnswer:
    """Return the pairs of links that stand still beside the parts of a cell, one on the other or in it."""
    pairs = graph.once(reach_of).standing
    if not pairs:
        return DisabledAnswer((), 1)
    alone, most = standing_part(graph), limits().robot_pairs
    if len(pairs) > most:
        return DisabledAnswer(
            (), 0, f"{len(pairs)} pairs of shapes stand at each other, which must be at most {most}", ROBOT_PAIRS
        )
    if faults := _unusable(alone):
        return DisabledAnswer((), 0, faults)
    urdf = with_shapes_at_hand(alone.once(shapes_and_joints), alone)
    roots = mesh_roots(alone.cell)
    return _kept("standing", f"{urdf}\0{pairs!r}", alone, DisabledAnswer, lambda: _at_rest(urdf, pairs, roots))


def _at_rest(urdf: str, pairs: tuple[tuple[str, str], ...], roots: tuple[Path, ...]) -> DisabledAnswer:
    from cellc.compiler.feasibility.compute import pairs_at_rest

    return pairs_at_rest(urdf, pairs, roots)


def _motion(graph: CellGraph) -> MotionAnswer:
    budget = _budget()
    answers = [_motion_in(part, graph, budget) for part in parts_of(graph)]
    return answers[0] if len(answers) == 1 else together(graph, answers, graph.once(_standing))


def _motion_in(graph: CellGraph, whole: CellGraph, budget: Budget) -> MotionAnswer:
    if refused := _refused(graph):
        message, limit = refused
        return MotionAnswer(refused=message, limit=limit)
    question = question_at_hand(graph, whole)
    roots = mesh_roots(graph.cell)
    return _kept("motion", repr(question), graph, MotionAnswer, lambda: _answered(question, roots, budget))


def question_at_hand(graph: CellGraph, whole: CellGraph | None = None) -> MotionQuestion:
    """Ask about the poses and goals of a cell, or of a part of one, with the shapes that are there."""
    question = motion_question(graph, whole)
    return replace(question, urdf=with_shapes_at_hand(question.urdf, graph))


def _answered(question: MotionQuestion, roots: tuple[Path, ...], budget: Budget) -> MotionAnswer:
    from cellc.compiler.feasibility.compute import answer

    stage("poses and goals")
    return answer(question, roots, budget)


def _budget() -> Budget:
    return Budget(limits().planning_seconds, time.process_time)


def _kept(kind: str, question: str, graph: CellGraph, answer: type[_Answer], compute: Callable[[], _Answer]) -> _Answer:
    """Return the kept answer to a question on a cell and on the mesh files that it names."""
    meshes = mesh_contents(graph)

    def is_kept(computed: _Answer) -> bool:
        return not computed.limit and mesh_contents(graph) == meshes

    return recall(kind, f"{question}\0{meshes}", answer, compute, is_kept, spec_of(graph))
