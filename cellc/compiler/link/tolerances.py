"""Tolerances of a controller, bound to its joints: one figure, one for each kind of joint, or one for each joint."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.cell.site import JointFigure
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import joint_figure
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.control import ControllerSpec
from cellc.compiler.spec.quantity import Quantity, QuantityVector
from cellc.contract.diagnostics import Diagnostic, YamlPath
from cellc.contract.frozen import dataclass

Figures = Mapping[str, JointFigure]
"""By ROS name of the joint; a joint without one is left out."""


@dataclass(frozen=True, slots=True)
class Tolerances:
    """What a controller allows on the way and at the end; None where nothing is stated."""

    path: Figures | None
    goal: Figures | None


UNSTATED = Tolerances(None, None)


def bind_tolerances(written: ControllerSpec, joints: Mapping[str, DeviceJoint]) -> Tolerances:
    """Return the figure of each joint; a joint that has none of its kind gets the first, which a rule reports.

    Args:
        joints: those of the controller, by `device/joint`.
    """
    return Tolerances(_figures(written.path_tolerance, joints), _figures(written.goal_tolerance, joints))


def _figures(written: QuantityVector | dict[str, Quantity] | None, joints: Mapping[str, DeviceJoint]) -> Figures | None:
    if written is None:
        return None
    if isinstance(written, dict):
        return {joint.name: joint_figure(written[name]) for name, joint in joints.items() if name in written}
    stated = [JointFigure(*pair) for pair in zip(written.si, written.linear, strict=True)]
    return {joint.name: _of_its_kind(stated, joint) for joint in joints.values()}


def _of_its_kind(stated: list[JointFigure], joint: DeviceJoint) -> JointFigure:
    return next((figure for figure in stated if figure.linear == joint.slides), stated[0])


def unknown_joints(
    written: ControllerSpec, joints: Iterable[str], document: SourceDocument, path: YamlPath
) -> tuple[Diagnostic, ...]:
    """Report tolerances of joints that the controller does not drive; ``joints`` are its own, as `device/joint`."""
    stated = {"path_tolerance": written.path_tolerance, "goal_tolerance": written.goal_tolerance}
    return tuple(
        unknown_name("unknown-joint", joint, "joint", joints, document, (*path, key, joint))
        for key, figures in stated.items()
        if isinstance(figures, dict)
        for joint in figures
        if joint not in set(joints)
    )
