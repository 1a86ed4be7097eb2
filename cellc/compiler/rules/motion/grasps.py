"""Rules on parts that grippers take: what must be known of them, and what fingers can hold and tell."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.cell.device import Gripper
from cellc.compiler.cell.frame import FRICTION, Frame, Grasp
from cellc.compiler.rules.carried import parts_taken
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.diagnostics import Span


def _gripped(graph: CellGraph) -> tuple[tuple[str, Gripper, Frame, Span], ...]:
    """Return each gripper with each part that it closes on, once, and the first step that does so."""
    return tuple(_closed(graph))


def _closed(graph: CellGraph) -> Iterator[tuple[str, Gripper, Frame, Span]]:
    parts, seen = graph.once(parts_taken), set[tuple[str, str]]()
    for step in (step for rehearsal in graph.cell.rehearsals for step in rehearsal.steps):
        part = parts.get(step.path)
        gripper, frame = graph.cell.device(step.name).gripper if part else None, graph.frames.get(part or "")
        if gripper is not None and frame is not None and (step.name, frame.name) not in seen:
            seen.add((step.name, frame.name))
            yield step.name, gripper, frame, step.span


def _stated(graph: CellGraph) -> Iterator[tuple[str, Gripper, Frame, Grasp, float, Span]]:
    for name, gripper, frame, span in graph.once(_gripped):
        if frame.grasp is not None and frame.grasp.width_m is not None:
            yield name, gripper, frame, frame.grasp, frame.grasp.width_m, span


@rule(Severity.BLOCKER)
def unknown_grasp(graph: CellGraph) -> Findings:
    """Yield parts that a rehearsal grips and whose width, tolerance or mass is not stated."""
    reported = set[str]()
    for name, _, frame, span in graph.once(_gripped):
        grasp = frame.grasp
        stated = (
            {} if grasp is None else {"width": grasp.width_m, "tolerance": grasp.tolerance_m, "mass": grasp.mass_kg}
        )
        missing = [key for key in ("width", "tolerance", "mass") if stated.get(key) is None]
        if missing and frame.name not in reported:
            reported.add(frame.name)
            listed = ", ".join(f"`{key}`" for key in missing)
            message = (
                f"`{name}` closes on `{frame.name}`, whose {listed} {'is' if len(missing) == 1 else 'are'} not stated"
            )
            path = (*frame.path, "grasp") if grasp is not None else frame.path
            yield found(graph, path, message, related=(Related("it closes here", span),))


@rule(Severity.ERROR)
def part_beyond_stroke(graph: CellGraph) -> Findings:
    """Yield parts that the open fingers of a gripper cannot reach round."""
    for name, gripper, frame, grasp, width_m, span in _stated(graph):
        widest_m = width_m + (grasp.tolerance_m or 0.0)
        if widest_m >= gripper.stroke_m:
            path = (*frame.path, "grasp", "width")
            more = (
                "" if grasp.tolerance_m is None else f" and a tolerance of {graph.cell.text(*path[:-1], 'tolerance')}"
            )
            message = f"the part at `{frame.name}` must be narrower than the {gripper.stroke_m * 1e3:.4g} mm that the"
            message = f"{message} fingers of `{name}` open to, got {graph.cell.text(*path)}{more}"
            related = enters(graph, "how far off it may be", (*path[:-1], "tolerance"))
            yield found(graph, path, message, related=(Related("it closes here", span), *related))


@rule(Severity.ERROR)
def refused_grip(graph: CellGraph) -> Findings:
    """Yield speeds and forces of a grip that the hardware of its gripper cannot be set to."""
    for device in graph.cell.devices:
        gripper, path = device.gripper, (*device.path, "grip")
        if gripper is None:
            if any(graph.cell.text(*path, key) for key in ("speed", "force")):
                yield found(graph, path, f"only a gripper has `grip`, got {device.kind} `{device.name}`")
            continue
        spans = (
            ("speed", gripper.grip_speed_m_s, None, gripper.max_speed_m_s, "m/s"),
            ("force", gripper.grip_force, gripper.min_force, gripper.max_force, "N"),
        )
        for key, stated, least, most, unit in spans:
            if stated is not None and (stated == 0.0 or not (least or 0.0) <= stated <= most):
                span = (
                    f"above 0 and at most {most:.4g} {unit}" if least is None else f"{least:.4g} to {most:.4g} {unit}"
                )
                message = f"`{key}` of the grip of `{device.name}` must be {span}, got {graph.cell.text(*path, key)}"
                yield found(graph, (*path, key), message)


@rule(Severity.ERROR, assumes=("part-beyond-stroke",))
def part_like_nothing(graph: CellGraph) -> Findings:
    """Yield tolerances with which fingers that hold a part are where they are without one."""
    for name, gripper, frame, grasp, width_m, span in _stated(graph):
        way = abs(gripper.open - gripper.closed)
        closed_m = gripper.stroke_m * gripper.goal_tolerance / way if way > 0.0 else 0.0
        if grasp.tolerance_m is not None and width_m - grasp.tolerance_m <= closed_m:
            path = (*frame.path, "grasp", "tolerance")
            closed = f"{closed_m * 1e3:.3g} mm, within which `{name}` counts as closed"
            stated = f"{graph.cell.text(*path[:-1], 'width')} less {graph.cell.text(*path)}"
            message = f"`width` less `tolerance` of `{frame.name}` must be more than {closed}, got {stated}"
            related = enters(graph, "how wide it is", (*path[:-1], "width"))
            yield found(graph, path, message, related=(Related("it closes here", span), *related))


_GRAVITY, _ARM = 9.81, 9.81
"""Two pads hold by dry friction a part that is accelerated with 1 g beside its weight."""


@rule(Severity.WARNING)
def grip_too_weak(graph: CellGraph) -> Findings:
    """Yield parts that fall out of the fingers at the stated force, or at the largest where none is stated."""
    for name, gripper, frame, span in graph.once(_gripped):
        mass_kg = None if frame.grasp is None else frame.grasp.mass_kg
        force = gripper.max_force if gripper.grip_force is None else gripper.grip_force
        friction = FRICTION if frame.grasp is None else frame.grasp.grips_with
        needed = (mass_kg or 0.0) * (_GRAVITY + _ARM) / (2.0 * friction)
        if 0.0 < force < needed:
            mass, stated = (*frame.path, "grasp", "mass"), (*graph.cell.device(name).path, "grip", "force")
            path, other = (mass, stated) if gripper.grip_force is None else (stated, mass)
            message = f"two pads of `{name}` must press with at least {needed:.3g} N to hold {mass_kg:g} kg in motion"
            related = [Related("it closes here", span)]
            if graph.cell.states(*other):
                related.insert(0, Related("the part is here", graph.cell.locate(*other)))
            advice = "take a stronger gripper" if path == mass else f"write at least `{math.ceil(needed)} N`"
            yield found(graph, path, f"{message}, got {force:g} N", advice, tuple(related))
