"""Which pairs of links need no collision check, and what named poses and goals of a cell lead to.

Both are computed by the planner and kept in the cache. The planner is imported where an answer has to be computed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from cellc.description.meshes import mesh_contents
from cellc.feasibility.answers import DisabledAnswer, DisabledLinks, MotionAnswer
from cellc.feasibility.question import MotionQuestion, motion_question, shapes_and_joints
from cellc.feasibility.touching_links import touching_links
from cellc.graph.cell_graph import CellGraph
from cellc.store.cache import recall

_Answer = TypeVar("_Answer")


def disabled_links(graph: CellGraph) -> DisabledAnswer:
    """Return the pairs with their reasons, for the SRDF and the contract.

    Where the planner refuses the description, because it names a mesh that is not here for instance, these are the
    pairs that follow from the tree alone.
    """
    return graph.once(_disabled)


def motion_answer(graph: CellGraph) -> MotionAnswer:
    """Return what poses and goals lead to; an empty answer where the cell has no group to move."""
    return graph.once(_motion) if graph.cell.groups else MotionAnswer()


def _disabled(graph: CellGraph) -> DisabledAnswer:
    urdf = shapes_and_joints(graph.cell)
    answer = _kept("disabled", urdf, urdf, DisabledAnswer, lambda: _sampled(urdf))
    if not answer.refused:
        return answer
    found = (
        DisabledLinks(min(first, second), max(first, second), reason.lower())
        for first, second, reason in touching_links(graph.cell)
    )
    return DisabledAnswer(tuple(sorted(found)), 0, answer.refused)


def _sampled(urdf: str) -> DisabledAnswer:
    from cellc.feasibility.compute import sample_pairs

    return sample_pairs(urdf)


def _motion(graph: CellGraph) -> MotionAnswer:
    question = motion_question(graph)
    return _kept("motion", repr(question), question.urdf, MotionAnswer, lambda: _answered(question))


def _answered(question: MotionQuestion) -> MotionAnswer:
    from cellc.feasibility.compute import answer

    return answer(question)


def _kept(kind: str, question: str, urdf: str, answer: type[_Answer], compute: Callable[[], _Answer]) -> _Answer:
    """Return the kept answer to a question on a description and on the mesh files that it names."""
    meshes = mesh_contents(urdf)
    if meshes is None:
        return compute()
    return recall(kind, f"{question}\0{meshes}", answer, compute, lambda: mesh_contents(urdf) == meshes)
