"""Which part each step of a rehearsal closes a gripper on."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.motion import CartesianGoal, Rehearsal
from cellc.compiler.graph.frame_tree import FrameTree, build_frame_tree
from cellc.contract.diagnostics import YamlPath


def gripped_parts(cell: Cell, frames: FrameTree) -> Mapping[YamlPath, str]:
    """Return the frame of the part that each closing step is to take: that of the goal where its arm is by then.

    A step that closes where the arm is at a named pose, or at a goal that no part is stated for, takes none: it is not
    here. An object that is observed is a part, whether its width is stated or not.
    """
    return {path: part for rehearsal in cell.rehearsals for path, part in _gripped(cell, frames, rehearsal)}


def heaviest_part(cell: Cell, grippers: Collection[str]) -> float | None:
    """Return the mass of the heaviest part that grippers close on, in kg; None where none is stated."""
    frames = build_frame_tree(cell)
    parts = gripped_parts(cell, frames)
    steps = (step for rehearsal in cell.rehearsals for step in rehearsal.steps if step.name in grippers)
    taken = (frames.get(parts[step.path]) for step in steps if step.path in parts)
    grasps = (frame.grasp for frame in taken if frame is not None)
    return max((grasp.mass_kg for grasp in grasps if grasp is not None and grasp.mass_kg is not None), default=None)


def _gripped(cell: Cell, frames: FrameTree, rehearsal: Rehearsal) -> Iterator[tuple[YamlPath, str]]:
    goals = {goal.name: goal for goal in cell.goals}
    groups = {pose.name: set[str]() for pose in cell.poses}
    for pose in cell.poses:
        groups[pose.name].add(pose.group)
    at: dict[str, CartesianGoal | None] = {}
    for step in rehearsal.steps:
        if step.kind == "move" and step.name in goals:
            at[goals[step.name].group] = goals[step.name]
        elif step.kind == "move":
            at |= dict.fromkeys(groups.get(step.name, ()))
        elif step.kind == "grip" and step.command == "close":
            goal = next((at.get(name) for name in _groups_of(cell, frames, step.name)), None)
            part = None if goal is None else part_of(frames, goal.frame)
            if part is not None:
                yield step.path, part


def _groups_of(cell: Cell, frames: FrameTree, gripper: str) -> Iterator[str]:
    """Yield the groups whose tip hangs on a gripper."""
    root = cell.device(gripper).body.root_link
    for group in cell.groups:
        if any(frame.name == root for frame in frames.chain(group.tip_frame)):
            yield group.name


def part_of(frames: FrameTree, name: str) -> str | None:
    """Return the nearest frame, from one up, that a part is stated for or that follows one; None where none does."""
    for frame in frames.chain(name):
        if frame.grasp is not None or frame.kind is FrameKind.DYNAMIC:
            return frame.name
        if frame.kind is not FrameKind.FIXED:
            return None
    return None
