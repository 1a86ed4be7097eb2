"""Figures of a gripper in a device.yaml against the joint that drives it: ends, speed, force and tolerance."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.catalog.device_model import DeviceModel, GripperFacts
from cellc.contract.diagnostics import YamlPath
from cellc.robot.description.model import Description, Joint

_ROUNDING = 0.02
"""Share of its way by which an end may lie beyond the limits of the joint: they are rounded."""
_RESOLVED = 0.1
"""Share of its way within which a gripper must tell whether it is at its goal: it tells parts by where it stops."""
_FASTER = 4.0
_STRONGER = 2.5
"""Times what the joint of the description does: an own choice, as vendors state both of them coarsely."""


def gripper_figures(model: DeviceModel, description: Description) -> Iterator[tuple[YamlPath, str]]:
    """Yield what the joint of a gripper cannot be."""
    facts = model.gripper
    joint = None if facts is None else description.joint(facts.joint)
    if facts is None or joint is None:
        return
    if joint.mimic is not None:
        message = f"`joint` must be the one that is driven, got `{facts.joint}`, which follows `{joint.mimic.joint}`"
        yield ("gripper", "joint"), message
    way = abs(facts.open.si - facts.closed.si)
    if way == 0.0:
        yield ("gripper", "closed"), f"`closed` must differ from `open`, got {facts.closed.text} for both"
    elif facts.open.linear == facts.closed.linear == joint.slides:
        yield from ((("gripper", key), message) for key, message in _against(facts, joint, way))


def _against(facts: GripperFacts, joint: Joint, way: float) -> Iterator[tuple[str, str]]:
    yield from _ends(facts, joint)
    if facts.goal_tolerance.linear == joint.slides and facts.goal_tolerance.si > _RESOLVED * way:
        got = facts.goal_tolerance.text
        yield "goal_tolerance", f"`goal_tolerance` must be at most a tenth of the way of the joint, got {got}"
    limit = joint.limit
    if limit is None:
        return
    speed = facts.stroke.si / way * (limit.velocity or 0.0)
    if 0.0 < _FASTER * speed < facts.max_speed.si:
        message = f"`max_speed` must fit the velocity of `{joint.name}`, with which the jaws have {speed:.3g} m/s,"
        yield "max_speed", f"{message} got {facts.max_speed.text}"
    if joint.slides and 0.0 < _STRONGER * (limit.effort or 0.0) < facts.max_force.si:
        message = f"`max_force` must fit the effort of `{joint.name}`, {limit.effort:.4g} N for each jaw,"
        yield "max_force", f"{message} got {facts.max_force.text}"


def _ends(facts: GripperFacts, joint: Joint) -> Iterator[tuple[str, str]]:
    limit = joint.limit
    if joint.type == "continuous" or limit is None or limit.lower is None or limit.upper is None:
        return
    slack = _ROUNDING * (limit.upper - limit.lower)
    for key, end in (("open", facts.open), ("closed", facts.closed)):
        if not limit.lower - slack <= end.si <= limit.upper + slack:
            unit = "m" if joint.slides else "rad"
            message = f"`{key}` must lie within the limits of `{joint.name}`, {limit.lower:.5g} to {limit.upper:.5g}"
            yield key, f"{message} {unit}, got {end.text}"
