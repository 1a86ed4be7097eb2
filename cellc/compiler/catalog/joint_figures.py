"""Figures of joints in a device.yaml, held against its description as both are read: units, and homes within limits."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.limit_facts import EVERY_JOINT
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.quantity import Quantity
from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span, YamlPath
from cellc.robot.description.model import Description, Joint, JointLimit

_UNITS = {
    "velocity": ("`m/s`", "`rad/s` or `deg/s`"),
    "velocity_everywhere": ("`m/s`", "`rad/s` or `deg/s`"),
    "effort": ("`N`", "`N m`"),
    "acceleration": ("`m/s^2`", "`rad/s^2`"),
    "jerk": ("`m/s^3`", "`rad/s^3`"),
}
"""By key of `limits`: units of a joint that slides, and of one that turns."""
_ROUNDING = 1e-9
"""By which a home may lie beyond a limit that was written with other digits, rad or m."""


def wrong_joint_figures(model: DeviceModel, description: Description, document: SourceDocument) -> Iterator[Diagnostic]:
    """Yield a finding for each figure of another unit than its joint has, and each home that its limits do not hold.

    Args:
        description: with the limits of the model.
    """
    for path, joint, figure in _figures(model, description):
        if joint.movable and joint.slides != figure.linear:
            units = _UNITS.get(str(path[1]) if path[0] == "limits" else "", ("`m` or `mm`", "`rad` or `deg`"))
            key = path[0] if path[0] == "home" else path[1]
            wanted = units[0] if joint.slides else units[1]
            message = f"`{key}` of `{joint.name}`, which is {joint.type}, must be in {wanted}, got {figure.text}"
            advice = "write a length where the joint slides, else an angle; a key of its own where `*` is of the others"
            yield _wrong(message, path, document, advice)
    for name, ends in model.limits.position.items():
        if ends.lower.si >= ends.upper.si:
            message = f"`lower` of `{name}` must be below its `upper`, got {ends.lower.text} and {ends.upper.text}"
            yield _wrong(message, ("limits", "position", name, "lower"), document, "write the lesser end as `lower`")
    for name, home in (model.home or {}).items():
        of = description.joint(name)
        limit = None if of is None or of.type == "continuous" or of.slides != home.linear else of.limit
        if limit is not None and not _holds(limit, home.si):
            bounds = f"from {_shown(limit.lower)} to {_shown(limit.upper)}"
            message = f"the home of `{name}` must lie {bounds}, got {home.si:.6g}"
            advice = "put the home between the limits of the joint"
            yield _wrong(message, ("home", name), document, advice, None if of is None else of.span)


def _wrong(
    message: str, path: YamlPath, document: SourceDocument, advice: str, described: Span | None = None
) -> Diagnostic:
    related = () if described is None else (Related("the joint is described here", described),)
    return Diagnostic("catalog-entry-invalid", Severity.ERROR, message, document.locate(path), path, advice, related)


def _figures(model: DeviceModel, description: Description) -> Iterator[tuple[YamlPath, Joint, Quantity]]:
    """Yield each figure with its place and the joints that it is of; `*` is of those that have no key of their own."""
    homes = model.home or {}
    yield from ((("home", joint.name), joint, homes[joint.name]) for joint in description.joints if joint.name in homes)
    for key, limits in model.limits.of_joints().items():
        for joint in description.joints:
            name = joint.name if joint.name in limits else EVERY_JOINT
            if name in limits and joint.mimic is None:
                for field, figure in limits[name].figures():
                    yield ("limits", key, name, field), joint, figure
    gripper = model.gripper
    driven = None if gripper is None else description.joint(gripper.joint)
    if gripper is not None and driven is not None:
        for key, figure in (
            ("open", gripper.open),
            ("closed", gripper.closed),
            ("goal_tolerance", gripper.goal_tolerance),
        ):
            yield ("gripper", key), driven, figure


def _holds(limit: JointLimit, position: float) -> bool:
    above = limit.lower is None or position >= limit.lower - _ROUNDING
    return above and (limit.upper is None or position <= limit.upper + _ROUNDING)


def _shown(bound: float | None) -> str:
    return "any" if bound is None else f"{bound:.6g}"
