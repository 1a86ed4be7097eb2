"""Tolerances of trajectory controllers as rules look at them: joint by joint."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.site import JointFigure


def stated(controller: Controller) -> Iterator[tuple[str, Mapping[str, JointFigure] | None]]:
    """Yield both keys of a controller with the figures by joint, None where it states none."""
    yield from (("path_tolerance", controller.path_tolerance), ("goal_tolerance", controller.goal_tolerance))
