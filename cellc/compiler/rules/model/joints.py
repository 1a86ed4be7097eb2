"""Rules on the joints of a description: axes, limits and mimics."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.rules.described import described, is_own
from cellc.compiler.rules.excuses import spared
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, did_you_mean, rule
from cellc.robot.description.model import Description, Joint, JointLimit


@rule(Severity.ERROR)
def circular_mimic(graph: CellGraph) -> Findings:
    """Yield each joint from which following the leaders leads back to it."""
    for part in graph.model.joints():
        followed = _leaders(part.device.body.description, part.joint)
        if part.joint.name in followed:
            chain = " → ".join(f"`{name}`" for name in (part.joint.name, *followed))
            message = f"joint `{part.joint.name}` mimics itself: {chain}"
            others = [name for name in followed if name != part.joint.name]
            yield Finding(message, part.span, part.path, related=described(graph, others))


def _leaders(description: Description, joint: Joint) -> list[str]:
    followed: list[str] = []
    leader: Joint | None = joint
    while leader is not None and leader.mimic is not None and leader.mimic.joint not in followed:
        followed.append(leader.mimic.joint)
        leader = description.joint(leader.mimic.joint)
    return followed


_FOUR_TURNS = 8.0 * math.pi


@rule(Severity.ERROR)
def degrees_as_radians(graph: CellGraph) -> Findings:
    """Yield revolute joints that could turn more than four times to one side."""
    for part in graph.model.joints():
        limit = part.joint.limit
        if part.joint.type != "revolute" or limit is None:
            continue
        largest = max(abs(limit.lower or 0.0), abs(limit.upper or 0.0))
        if largest > _FOUR_TURNS:
            turns = largest / (2.0 * math.pi)
            message = f"joint `{part.joint.name}` has a limit of {largest:g} rad, which is {turns:.1f} turns"
            advice = f"write {math.radians(largest):.6g} if {largest:g} is in degrees"
            yield Finding(message, limit.span or part.span, part.path, advice)


_BEYOND = 0.1
"""Share of its way by which a follower may be sent beyond its limits: they are rounded, and often a little tight."""


@rule(Severity.WARNING, assumes=("circular-mimic", "mimic-of-fixed-joint", "mimic-of-nothing", "reversed-limits"))
def mimic_beyond_limits(graph: CellGraph) -> Findings:
    """Yield followers that the range of their leader sends beyond their own limits, in descriptions of the user."""
    for part in graph.model.joints():
        mimic, limit = part.joint.mimic, part.joint.limit
        leader = None if mimic is None else part.device.body.description.joint(mimic.joint)
        if mimic is None or leader is None or limit is None or leader.limit is None or not is_own(graph, part.device):
            continue
        ends = (leader.limit.lower, leader.limit.upper, limit.lower, limit.upper)
        if part.joint.type == "continuous" or None in ends or leader.mimic is not None:
            continue
        first, second = sorted(mimic.multiplier * (end or 0.0) + mimic.offset for end in ends[:2])
        lower, upper = ends[2] or 0.0, ends[3] or 0.0
        if max(lower - first, second - upper) > max(1e-6, _BEYOND * (second - first)) and lower < upper:
            unit = "m" if part.joint.slides else "rad"
            message = f"joint `{part.joint.name}` must stay between {lower:g} and {upper:g} {unit}, but `{leader.name}`"
            message += f" sends it from {first:.4g} to {second:.4g} {unit}"
            related = described(graph, [leader.name])
            yield Finding(message, mimic.span or part.span, part.path, related=related)


@rule(Severity.ERROR)
def mimic_of_fixed_joint(graph: CellGraph) -> Findings:
    """Yield mimic joints whose leader is fixed."""
    for part in graph.model.joints():
        mimic = part.joint.mimic
        leader = None if mimic is None else part.device.body.description.joint(mimic.joint)
        if leader is not None and not leader.movable:
            message = f"joint `{part.joint.name}` mimics `{leader.name}`, which is {leader.type}"
            movable = (joint.name for joint in part.device.body.description.joints if joint.movable)
            advice = did_you_mean(leader.name, movable, "moving joints")
            yield Finding(message, part.span, part.path, advice, described(graph, [leader.name]))


@rule(Severity.ERROR)
def mimic_of_nothing(graph: CellGraph) -> Findings:
    """Yield mimic joints whose leader is missing."""
    for part in graph.model.joints():
        mimic = part.joint.mimic
        description = part.device.body.description
        if mimic is not None and description.joint(mimic.joint) is None:
            message = f"joint `{part.joint.name}` mimics `{mimic.joint}`, which is not a joint of `{part.device.name}`"
            names = (joint.name for joint in description.joints)
            yield Finding(message, part.span, part.path, did_you_mean(mimic.joint, names, "joints"))


@rule(Severity.ERROR)
def missing_joint_limits(graph: CellGraph) -> Findings:
    """Yield joints with ends of which a limit is not stated."""
    for part in graph.model.joints():
        missing = tuple(_missing(part.joint))
        if missing and not spared(graph, part.device, part.joint.name, "missing-joint-limits"):
            names = ", ".join(f"`{name}`" for name in missing)
            message = f"{part.joint.type} joint `{part.joint.name}` does not state {names}"
            yield Finding(message, part.span, part.path)


def _missing(joint: Joint) -> Iterator[str]:
    """Yield what every reader of the description asks of the joint and the description does not have."""
    limit, has_ends = joint.limit or JointLimit(None, None, None, None), joint.type in ("revolute", "prismatic")
    if has_ends:
        stated = {"lower": limit.lower, "upper": limit.upper, "velocity": limit.velocity}
        yield from (name for name, value in stated.items() if value is None)
    # A limit without both is an excused one, or none.
    if (has_ends or joint.type == "continuous") and limit.velocity is not None and limit.effort is None:
        yield "effort"


_TOLERANCE = 1e-3  # axes are often written with three or four digits


@rule(Severity.ERROR)
def non_unit_axis(graph: CellGraph) -> Findings:
    """Yield axes whose length is neither zero, which is another mistake, nor one."""
    for part in graph.model.joints():
        length = math.hypot(*part.joint.axis)
        if part.joint.movable and length > 0.0 and abs(length - 1.0) > _TOLERANCE:
            message = f"the axis of joint `{part.joint.name}` must have length 1, got {length:g}"
            unit = " ".join(f"{component / length:.6g}" for component in part.joint.axis)
            yield Finding(message, part.span, part.path, f"write `{unit}` if the direction is right")


@rule(Severity.ERROR)
def reversed_limits(graph: CellGraph) -> Findings:
    """Yield joints without a single allowed position."""
    for part in graph.model.joints():
        limit = part.joint.limit
        if limit is None or limit.lower is None or limit.upper is None or limit.lower <= limit.upper:
            continue
        message = f"joint `{part.joint.name}` has lower limit {limit.lower:g} above upper limit {limit.upper:g}"
        yield Finding(message, limit.span or part.span, part.path)


@rule(Severity.ERROR)
def zero_axis(graph: CellGraph) -> Findings:
    """Yield joints that have no direction."""
    for part in graph.model.joints():
        if part.joint.movable and math.hypot(*part.joint.axis) == 0.0:
            message = f"joint `{part.joint.name}` is {part.joint.type} but its axis is `0 0 0`"
            yield Finding(message, part.span, part.path)
