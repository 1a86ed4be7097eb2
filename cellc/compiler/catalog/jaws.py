"""A gripper held against the kinematics of its description: which way its jaws run, and how far.

The jaws are where its joint and the joints that mimic it put them at ``open`` and at ``closed``. What a description
does not tell, such as where a jaw is whose links have their origins in the palm, is not judged.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations

from cellc.compiler.catalog.device_model import DeviceModel, GripperFacts
from cellc.compiler.catalog.gripper_figures import gripper_figures
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span, YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3
from cellc.robot.description.model import Description, Joint, Link, Mesh
from cellc.robot.description.posture import posture

CODE = "gripper-against-description"
_ADVICE = "write the figure that the joint has, or correct the joint"
_STILL_M = 1e-4
_SHARE = 0.25
"""By which a stroke may differ from that of the joints: pads are worn, and data sheets round."""


@dataclass(frozen=True, slots=True)
class _Jaw:
    """The last link of a row of joints that move with the gripper, with the joint that drives the row.

    Args:
        closed, open: its pose in the root link.
        point: what is known to be in the jaw, in its link; None where nothing is.
    """

    link: str
    driver: Joint
    closed: Pose
    open: Pose
    point: Vector3 | None

    @property
    def way(self) -> Vector3:
        """How it moves as the gripper opens, m."""
        point = self.point or (0.0, 0.0, 0.0)
        return _minus(self.open.apply(point), self.closed.apply(point))

    @property
    def slides(self) -> bool:
        """Whether it keeps its orientation, so that each of its points moves alike."""
        return math.hypot(*(self.closed.inverse() @ self.open).rotation_vector()) < 1e-3


def gripper_faults(model: DeviceModel, description: Description, document: SourceDocument) -> Iterator[Diagnostic]:
    """Yield what the figures of a gripper say other than its description.

    Args:
        description: with the limits of the model.
    """
    facts = model.gripper
    joint = None if facts is None else description.joint(facts.joint)
    for path, message in gripper_figures(model, description):
        yield _found(message, path, document, _ADVICE, None if joint is None else joint.span)
    if facts is None or joint is None or facts.open.si == facts.closed.si or facts.open.linear != joint.slides:
        return
    jaws = _jaws(facts, description)
    if len(jaws) > 1:
        first, second = max(combinations(jaws, 2), key=lambda pair: math.hypot(*_minus(pair[0].way, pair[1].way)))
        yield from _of_two(facts, first, second, document, even=all(_along(jaw, first, second) for jaw in jaws))
    elif jaws and joint.slides and jaws[0].slides:
        way = math.hypot(*jaws[0].way)
        alone = sum(other.slides and other.mimic is None for other in description.joints) == 1
        if way > _STILL_M and not _fits(facts.stroke.si, way) and (alone or not _fits(facts.stroke.si, 2.0 * way)):
            yield _stroke(facts, way, document, joint)


def _of_two(
    facts: GripperFacts, first: _Jaw, second: _Jaw, document: SourceDocument, *, even: bool
) -> Iterator[Diagnostic]:
    """Yield what is wrong of the two jaws that move most against each other; ``even`` where all move along one line."""
    apart = _minus(first.way, second.way)
    distance, own = math.hypot(*apart), max(math.hypot(*first.way), math.hypot(*second.way))
    slide = first.slides and second.slides
    if slide and own > _STILL_M and distance < 0.05 * own:
        message = f"links `{first.link}` and `{second.link}` move to the same side as `{facts.joint}` opens the gripper"
        follower = second.driver if second.driver.mimic is not None else first.driver
        place = None if follower.mimic is None else follower.mimic.span or follower.span
        yield _found(message, ("gripper", "joint"), document, "turn the axis or the sign of the multiplier", place)
    elif (growth := _growth(first, second)) is not None and growth < -0.2 * facts.stroke.si:
        message = f"`open` must have the jaws farther apart than `closed`, got {facts.open.text} and"
        message += f" {facts.closed.text}, where they are {-growth * 1e3:.3g} mm nearer"
        yield _found(message, ("gripper", "open"), document, "swap the two, or correct the axis", first.driver.span)
    elif even and slide and distance > _STILL_M and not _fits(facts.stroke.si, distance):
        yield _stroke(facts, distance, document, first.driver, second.driver)


def _stroke(facts: GripperFacts, way: float, document: SourceDocument, *drivers: Joint) -> Diagnostic:
    message = f"`stroke` must be how far one jaw moves relative to the other, {way * 1e3:.3g} mm by the joints,"
    advice = "write the way between both jaws, or correct `open` and `closed`"
    return _found(f"{message} got {facts.stroke.text}", ("gripper", "stroke"), document, advice, *map(_place, drivers))


def _place(joint: Joint) -> Span | None:
    return joint.span if joint.mimic is None else joint.mimic.span or joint.span


def _found(message: str, path: YamlPath, document: SourceDocument, advice: str, *places: Span | None) -> Diagnostic:
    related = tuple(Related("the joint is described here", place) for place in places if place is not None)
    return Diagnostic(CODE, Severity.WARNING, message, document.locate(path), path, advice, related)


def _fits(stroke: float, way: float) -> bool:
    return (1.0 - _SHARE) * way <= stroke <= (1.0 + _SHARE) * way


def _jaws(facts: GripperFacts, whole: Description) -> tuple[_Jaw, ...]:
    """Return the last link of each row of joints that move with the gripper."""
    description = whole.with_direct_mimics()
    followers = (joint for joint in description.joints if joint.mimic is not None)
    driven = {joint.name for joint in followers if joint.mimic is not None and joint.mimic.joint == facts.joint}
    driven.add(facts.joint)
    closed, opened = (posture(description, {facts.joint: at.si}) for at in (facts.closed, facts.open))
    carrying = {joint.parent for joint in description.joints if joint.name in driven}
    return tuple(
        _Jaw(link.name, joint, closed[link.name], opened[link.name], _point(link))
        for joint in description.joints
        if joint.name in driven and joint.child not in carrying and joint.child in closed
        for link in (description.link(joint.child),)
        if link is not None
    )


def _along(jaw: _Jaw, first: _Jaw, second: _Jaw) -> bool:
    """Tell whether a jaw moves along the line of two others, or hardly at all."""
    line, way = _minus(first.way, second.way), jaw.way
    length, own = math.hypot(*line), math.hypot(*way)
    return own < 0.2 * length or abs(sum(a * b for a, b in zip(line, way, strict=True))) > 0.7 * length * own


def _point(link: Link) -> Vector3 | None:
    """Return the middle of a link, as its center of mass or its simple shapes tell."""
    if link.inertial is not None and math.hypot(*link.inertial.pose.position) > _STILL_M:
        return link.inertial.pose.position
    shapes = [shape.pose.position for shape in link.collisions if not isinstance(shape.geometry, Mesh)]
    if not shapes:
        return None
    x, y, z = (sum(axis) / len(shapes) for axis in zip(*shapes, strict=True))
    return x, y, z


def _growth(first: _Jaw, second: _Jaw) -> float | None:
    """Return by how much two jaws come apart as the gripper opens, m; None where it is not known where they are."""
    if first.point is None or second.point is None:
        return None
    apart = [
        math.dist(one.apply(first.point), other.apply(second.point))
        for one, other in ((first.open, second.open), (first.closed, second.closed))
    ]
    return apart[0] - apart[1]


def _minus(first: Vector3, second: Vector3) -> Vector3:
    return first[0] - second[0], first[1] - second[1], first[2] - second[2]
