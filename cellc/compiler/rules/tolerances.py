"""Tolerances of trajectory controllers as rules look at them: joint by joint."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.site import JointFigure
from cellc.compiler.rules.kit import CellGraph, Findings, found
from cellc.contract.vocabulary import TRAJECTORIES

KEYS = ("path_tolerance", "goal_tolerance")


def stated(controller: Controller) -> Iterator[tuple[str, Mapping[str, JointFigure] | None]]:
    """Yield both keys of a controller with the figures by joint, None where it states none."""
    yield from zip(KEYS, (controller.path_tolerance, controller.goal_tolerance), strict=True)


def unwatched_joints(graph: CellGraph, key: str) -> Findings:
    """Yield trajectory controllers that state no tolerance, or none for some joint, or zero, which is no check."""
    for controller in graph.cell.controllers:
        if controller.behaviour not in TRAJECTORIES:
            continue
        figures = dict(stated(controller))[key]
        if figures is None:
            yield found(graph, controller.path, f"`{controller.name}` does not state `{key}`")
            continue
        path = (*controller.path, key)
        untold = [joint for joint in controller.joints if joint not in figures]
        if untold:
            yield found(graph, path, f"`{key}` of `{controller.name}` states nothing for `{untold[0]}`")
        elif not all(figure.value for figure in figures.values()):
            message = f"`{key}` of `{controller.name}` must be above zero, which switches the check off"
            yield found(graph, path, message)
