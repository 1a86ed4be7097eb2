"""Rules on the caps of planned motion, and on the stages to them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from cellc.compiler.cell.site import Commissioning, FirstMotion
from cellc.compiler.graph.commissioning import Stage, chain_of, stages, tip_bounds, tip_in_base
from cellc.compiler.rules.geometry import placed_by
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, enters, found, rule

_CAPS: YamlPath = ("bringup", "commissioning")
_ASSESSED: YamlPath = ("safety", "risk_assessment")
_ROUNDING = 1.0 + 1e-9


@rule(Severity.BLOCKER, assumes=("shared-prefix",))
def missing_commissioning(graph: CellGraph) -> Findings:
    """Yield cells that plan motion and state no caps for its first stages."""
    if graph.cell.bringup.caps is None and _plans(graph):
        yield found(graph, _CAPS, "the caps of planned motion after gate G6 are not stated")


@rule(Severity.ERROR)
def disordered_stages(graph: CellGraph) -> Findings:
    """Yield stages that do not rise, or do not end at the caps themselves."""
    caps = graph.cell.bringup.caps
    if caps is not None and (any(a >= b for a, b in pairwise(caps.stages)) or caps.stages[-1] != 1.0):
        got = graph.cell.text(*_CAPS, "stages")
        yield found(graph, (*_CAPS, "stages"), f"`stages` must rise and end at 100 %, got {got}")


_FIRST_SHARE, _STEP = 0.25, 5.0
_REDUCED_M_S = 0.25
"""The reduced speed of ISO 10218-1: below it, a first stage may be any share."""


@rule(
    Severity.WARNING, assumes=("disordered-stages", "caps-of-nothing", "missing-velocity-limit", "caps-above-hardware")
)
def hasty_stages(graph: CellGraph) -> Findings:
    """Yield stages that begin fast, or of which one is many times as fast as the one before it."""
    caps, first = graph.cell.bringup.caps, next(iter(stages(graph)), None)
    if caps is None or first is None:
        return
    fastest = max(first.tips.values(), default=0.0)
    path = (*_CAPS, "stages") if graph.cell.states(*_CAPS, "stages") else _CAPS
    if caps.velocity * caps.stages[0] > _FIRST_SHARE and fastest > _REDUCED_M_S:
        message = f"the first stage must be at most {_FIRST_SHARE:.0%} of full speed, or {_REDUCED_M_S * 1e3:g} mm/s"
        yield found(
            graph,
            path,
            f"{message}, got {caps.velocity * caps.stages[0]:.0%}, at which a tip may reach {fastest:.2g} m/s",
            related=(*enters(graph, "full speed is this", (*_CAPS, "velocity")), *_of_tips(graph)),
        )
    for before, after in pairwise(caps.stages):
        if after > before * _STEP * _ROUNDING:
            message = f"a stage must be at most {_STEP:g} times as fast as the one before it"
            yield found(graph, path, f"{message}, got {before:.0%} and then {after:.0%}")


@rule(Severity.ERROR)
def caps_of_nothing(graph: CellGraph) -> Findings:
    """Yield caps of a cell in which nothing is planned, and a grip force where nothing grips."""
    caps = graph.cell.bringup.caps
    if caps is not None and not _plans(graph):
        yield found(graph, _CAPS, "no node of this cell plans, so nothing reads the caps of `commissioning`")
    elif caps is not None and caps.force is not None and not _forces(graph):
        yield found(graph, (*_CAPS, "force"), "no device of this cell grips, so `force` caps nothing")


@rule(Severity.ERROR, assumes=("caps-of-nothing", "missing-velocity-limit"))
def caps_above_hardware(graph: CellGraph) -> Findings:
    """Yield caps above what joints and grippers have anyway."""
    caps = graph.cell.bringup.caps
    for name, cap, most in () if caps is None else _against_hardware(graph, caps):
        if cap > most * _ROUNDING:
            unit = {"reach": " m", "force": " N", "velocity": " m/s"}.get(name, "")
            allowed = "100 %" if name == "acceleration" or (name, most) == ("velocity", 1.0) else f"{most:.3g}{unit}"
            message = f"`{name}` must be at most {allowed}, which the hardware has, got {graph.cell.text(*_CAPS, name)}"
            yield found(graph, (*_CAPS, name), message)


def _against_hardware(graph: CellGraph, caps: Commissioning) -> Iterator[tuple[str, float, float]]:
    """Yield each cap with the most that the hardware has."""
    if caps.tip_speed is None:
        yield "velocity", caps.velocity, 1.0
    else:
        yield "velocity", caps.tip_speed, max(graph.once(tip_bounds).values())
    yield "acceleration", caps.acceleration, 1.0
    if caps.reach is not None:
        yield "reach", caps.reach, max(chain_of(graph, group).length for group in graph.cell.groups)
    if caps.force is not None:
        yield "force", caps.force, max(_forces(graph), default=math.inf)


@rule(Severity.ERROR, assumes=("caps-of-nothing", "disordered-stages", "missing-velocity-limit"))
def caps_above_risk_assessment(graph: CellGraph) -> Findings:
    """Yield caps above what the risk assessment allows, and figures of it that nothing caps."""
    assessed, caps = graph.cell.safety.risk_assessment, graph.cell.bringup.caps
    if assessed is None or caps is None:
        return
    tips = stages(graph)[-1].tips
    group = max(tips, key=lambda name: tips[name], default="")
    force = max(_forces(graph), default=None) if caps.force is None else caps.force
    for name, unit, allowed, cap, of in (
        ("velocity", "m/s", assessed.velocity, tips.get(group), f"the tip of `{group}`"),
        ("reach", "m", assessed.reach, math.inf if caps.reach is None else caps.reach, "a tip"),
        ("force", "N", assessed.force, force, "a gripper"),
    ):
        if allowed is not None and cap is not None and cap > allowed * _ROUNDING:
            what = "any" if math.isinf(cap) else f"up to {cap:.3g} {unit} of"
            figure = graph.cell.text(*_ASSESSED, name)
            message = f"the caps must allow at most the assessed {figure} of `{name}`, but leave {of} {what} {name}"
            related: tuple[Related, ...] = (
                Related(f"{assessed.document} allows this", graph.cell.locate(*_ASSESSED, name)),
            )
            related += _of_tips(graph) if name == "velocity" else ()
            yield found(graph, (*_CAPS, name), message, related=related)


@rule(
    Severity.ERROR,
    assumes=(
        *("caps-of-nothing", "disordered-stages", "limit-share-of-nothing"),
        *("first-motion-of-unknown-joint", "first-motion-too-large"),
    ),
)
def first_motion_above_stage(graph: CellGraph) -> Findings:
    """Yield first motions that are faster than the first stage leaves one of the joints that they move."""
    for stage in stages(graph)[:1]:
        for motion in graph.cell.bringup.first_motions:
            left = dict(_left(graph, motion, stage))
            slowest = min(left, key=lambda name: left[name], default="")
            if slowest and motion.velocity.value > left[slowest] * _ROUNDING:
                most = left[slowest] if motion.velocity.linear else math.degrees(left[slowest])
                unit, got = ("m/s" if motion.velocity.linear else "deg/s"), graph.cell.text(*motion.path, "velocity")
                message = (
                    f"the first motion must be at most {most:.3g} {unit}, which the first stage allows `{slowest}`"
                )
                related = enters(graph, "the first stage is this share", (*_CAPS, "velocity"))
                related += _limits(graph)
                yield found(graph, (*motion.path, "velocity"), f"{message}, got {got}", related=related)


def _left(graph: CellGraph, motion: FirstMotion, stage: Stage) -> Iterator[tuple[str, float]]:
    """Yield what a stage leaves each joint that is planned for and that a first motion moves, rad/s or m/s."""
    planned = {name for group in graph.cell.groups for name in group.joints}
    for joint in graph.cell.device(motion.device).actuated_joints:
        cap = stage.joints[joint.name].velocity if joint.name in planned else None
        if cap is not None and joint.slides == motion.velocity.linear:
            yield joint.name, cap


@rule(Severity.ERROR, assumes=("caps-of-nothing", "frame-cycle", "detached-mount"))
def beyond_capped_reach(graph: CellGraph) -> Findings:
    """Yield poses and goals whose tip is farther from the base of its group than the caps allow."""
    caps = graph.cell.bringup.caps
    if caps is None or caps.reach is None:
        return
    for path, what, distance in _distances(graph):
        if distance > caps.reach * _ROUNDING:
            stated = graph.cell.text(*_CAPS, "reach")
            message = f"{what} must be within {stated} of the base of its group, got {distance * 1e3:.0f} mm"
            yield found(graph, path, message, related=(Related("the cap", graph.cell.locate(*_CAPS, "reach")),))


def _distances(graph: CellGraph) -> Iterator[tuple[YamlPath, str, float]]:
    """Yield each pose and goal with the distance of its tip from the base, in m, where both are known."""
    groups = {group.name: group for group in graph.cell.groups}
    for pose in graph.cell.poses:
        at = dict(zip(pose.joints, pose.positions, strict=True))
        tip = tip_in_base(graph, groups[pose.group], at)
        if tip is not None:
            yield pose.path, f"pose `{pose.name}` of `{pose.group}`", math.hypot(*tip.position)
    for goal in graph.cell.goals:
        frame, base = graph.frames.in_world(goal.frame), graph.frames.in_world(groups[goal.group].base_link)
        if frame is not None and base is not None:
            place = base.inverse() @ frame @ goal.transform_tip_to_frame
            yield goal.path, f"goal `{goal.name}`", math.hypot(*place.position)


def _plans(graph: CellGraph) -> bool:
    return bool(graph.cell.groups and graph.cell.planners)


def _forces(graph: CellGraph) -> list[float]:
    return [device.gripper.max_force for device in graph.cell.devices if device.gripper is not None]


def _limits(graph: CellGraph) -> tuple[Related, ...]:
    return enters(graph, "so fast joints are", *((*device.path, "limits") for device in graph.cell.devices))


def _of_tips(graph: CellGraph) -> tuple[Related, ...]:
    """Return what the speed of a tip follows from: limits of joints, and where the tip is."""
    return (*_limits(graph), *placed_by(graph, *(group.tip_frame for group in graph.cell.groups)))
