"""The answers about named poses and goals of a cell."""

from __future__ import annotations

from cellc.feasibility.answers import MotionAnswer
from cellc.feasibility.disabled import disabled_in
from cellc.feasibility.question import MotionQuestion, motion_question
from cellc.graph.cell_graph import CellGraph
from cellc.store.cache import recall


def motion_answer(graph: CellGraph) -> MotionAnswer:
    """Return what poses and goals lead to; an empty answer where the cell has no group to move."""
    return graph.once(_of_cell) if graph.cell.groups else MotionAnswer()


def _of_cell(graph: CellGraph) -> MotionAnswer:
    question = motion_question(graph)
    return recall("motion", repr(question), MotionAnswer, lambda: _computed(question))


def _computed(question: MotionQuestion) -> MotionAnswer:
    from cellc.feasibility.compute import answer

    disabled = disabled_in(question.urdf)
    return MotionAnswer(refused=disabled.refused) if disabled.refused else answer(question, disabled.pairs)
