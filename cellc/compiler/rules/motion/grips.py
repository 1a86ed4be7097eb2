"""Bounds of grips: parts against what fingers resolve, goals against their play, settings of controllers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.device import Device, Gripper
from cellc.compiler.cell.frame import Grasp
from cellc.compiler.graph.claims import written_parameters
from cellc.compiler.graph.grips import part_of
from cellc.compiler.rules.bounds import Bound, Figure, outside
from cellc.compiler.rules.carried import parts_taken
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, rule
from cellc.contract.vocabulary import Behavior


def _parts(graph: CellGraph) -> Mapping[str, Device]:
    """Return for each part that is gripped the first gripper that closes on it."""
    devices: dict[str, Device] = {}
    parts = graph.once(parts_taken)
    for step in (step for rehearsal in graph.cell.rehearsals for step in rehearsal.steps):
        if step.path in parts:
            devices.setdefault(parts[step.path], graph.cell.device(step.name))
    return devices


def _grasps(graph: CellGraph) -> Iterator[tuple[YamlPath, Grasp, Device, Gripper]]:
    for frame in graph.cell.frames:
        device = graph.once(_parts).get(frame.name)
        if frame.grasp is not None and device is not None and device.gripper is not None:
            yield (*frame.path, "grasp"), frame.grasp, device, device.gripper


_RESOLVED = 0.5
"""Share of what a gripper ends from its goal that still tells a right part from a wrong one, most of the time."""
_SOFT = 0.25


def _tolerances(graph: CellGraph) -> Iterator[Figure]:
    """Yield the tolerance of each part between what its gripper resolves and a quarter of its width."""
    for path, grasp, device, gripper in _grasps(graph):
        way = abs(gripper.open - gripper.closed)
        if grasp.tolerance_m is None or grasp.width_m is None or way == 0.0:
            continue
        resolved = gripper.stroke_m * gripper.goal_tolerance / way
        why = f"from what `{device.name}` resolves to a quarter of the width"
        related = (Related("its width", graph.cell.locate(*path, "width")),)
        most = max(_SOFT * grasp.width_m, resolved)
        yield Figure((*path, "tolerance"), grasp.tolerance_m, _RESOLVED * resolved, most, why, related=related)


_PLAY = 1.25


def _plays(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far a tip may be from the goal at which fingers close, which is at most the play of the part."""
    uncertainty = graph.cell.uncertainty
    grasps = {path[:-1]: (grasp, gripper) for path, grasp, _, gripper in _grasps(graph)}
    for goal in graph.cell.goals if uncertainty is not None and grasps else ():
        frame = graph.frames.get(part_of(graph.frames, goal.frame) or "")
        stated = None if uncertainty is None else uncertainty.tolerances_m.get(goal.name)
        grasp, gripper = grasps.get(() if frame is None else frame.path, (None, None))
        if grasp is None or gripper is None or grasp.width_m is None or stated is None or frame is None:
            continue
        play = (gripper.stroke_m - grasp.width_m) / 2.0
        related = (Related("the part is here", graph.cell.locate(*frame.path, "grasp", "width")),)
        yield Figure(("uncertainty", "tolerances", goal.name), stated, most=_PLAY * max(play, 0.0), related=related)


def _settings(graph: CellGraph) -> Iterator[tuple[YamlPath, str, float, Device, Gripper]]:
    """Yield each number that is written for a controller of a gripper: its place, its name and its value."""
    for parameter in written_parameters(graph.cell):
        controller, value = parameter.controller, parameter.value
        device = None if controller.device is None else graph.cell.device(controller.device)
        gripping = controller.behavior in (Behavior.PARALLEL_GRIPPER, Behavior.POSITION_GRIPPER)
        if gripping and device is not None and device.gripper is not None and isinstance(value, (int, float)):
            yield parameter.path, parameter.name, float(value), device, device.gripper


_STALLS_S = 0.05
"""Fingers that begin to move are not stalled yet: drives take some cycles."""
_COARSE = 0.1


def _controllers(graph: CellGraph) -> Iterator[Figure]:
    for path, name, value, device, gripper in _settings(graph):
        joint = device.joint(gripper.joint)
        unit, way = "m" if joint.slides else "rad", abs(gripper.open - gripper.closed)
        grip = graph.cell.locate(*device.path, "grip")
        related = (Related("the grip is here", grip),) if graph.cell.states(*device.path, "grip") else ()
        if name == "stall_velocity_threshold" and gripper.max_velocity:
            why = f"half of what `{joint.name}` does as it closes"
            yield Figure(path, value, most=gripper.max_velocity / 2.0, because=why, unit=f"{unit}/s", related=related)
        elif name == "stall_timeout":
            yield Figure(path, value, _STALLS_S, because="in which fingers begin to move", unit="s")
        elif name == "goal_tolerance":
            yield Figure(path, value, most=_COARSE * way, because=f"a tenth of the way of `{joint.name}`", unit=unit)
        elif name == "max_effort" and joint.slides and gripper.max_force > 0.0:
            why = f"what `{device.name}` has"
            yield Figure(path, value, most=gripper.max_force, because=why, unit="N", related=related)


BOUNDS = (
    Bound(("frames.*.grasp.tolerance",), "`tolerance` of the part", "mm", "", _tolerances),
    Bound(
        ("uncertainty.tolerances.*",), "the tolerance of the goal", "mm", "the play between part and fingers", _plays
    ),
    Bound(("control.controllers.*.parameters.*",), "the parameter", "", "", _controllers),
)


@rule(
    Severity.WARNING,
    assumes=("part-beyond-stroke", "part-like-nothing", "wrong-parameter-type", "implausible-size"),
    gives_way=True,
)
def implausible_grip(graph: CellGraph) -> Findings:
    """Yield figures of parts, goals and gripper controllers with which a gripper does not tell what it does."""
    yield from outside(graph, BOUNDS)
