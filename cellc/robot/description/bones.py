"""Lines through the bodies of a robot, from joint to joint: what an eye takes for its limbs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from cellc.contract.transforms import Pose, Vector3
from cellc.robot.description.model import Description, Joint, Link

_SHORTEST_M = 1e-3


def bones(description: Description, poses: Mapping[str, Pose]) -> Iterator[tuple[Vector3, Vector3]]:
    """Yield the ends of each line, in the frame of the poses.

    Frames of a series of turning joints may lie beside the limbs, all in one plane. So a line runs through a limb where
    its shapes are: it begins and ends at the point of each joint's axis that is nearest to them. It follows the
    axis from one limb to the next; that of a slide begins where its joint is at zero.
    """
    links = {link.name: link for link in description.links}
    outgoing: dict[str, list[Joint]] = {}
    incoming: dict[str, Joint] = {}
    for joint in description.joints:
        if joint.parent in poses and joint.child in poses:
            outgoing.setdefault(joint.parent, []).append(joint)
            incoming[joint.child] = joint
    for name, pose in poses.items():
        middle = _middle(links[name], pose)
        begin = _passed(incoming[name], poses, middle, name) if name in incoming else pose.position
        for joint in outgoing.get(name, ()):
            end = _passed(joint, poses, middle, name)
            ends = (end, _passed(joint, poses, _middle(links[joint.child], poses[joint.child]), joint.child))
            yield from (line for line in ((begin, end), ends) if math.dist(*line) > _SHORTEST_M)


def _middle(link: Link, pose: Pose) -> Vector3 | None:
    places = [pose.apply(shape.pose.position) for shape in link.collisions]
    if not places:
        return None
    x, y, z = (sum(values) / len(places) for values in zip(*places, strict=True))
    return x, y, z


def _passed(joint: Joint, poses: Mapping[str, Pose], middle: Vector3 | None, link: str) -> Vector3:
    """Return where the line of a link meets a joint."""
    zero, child = poses[joint.parent] @ joint.pose, poses[joint.child]
    if joint.slides:
        return zero.position if link == joint.parent else child.position
    if middle is None or not joint.movable:
        return child.position
    ahead = zero.apply(joint.axis)
    axis = [tip - foot for tip, foot in zip(ahead, zero.position, strict=True)]
    square = sum(value * value for value in axis) or 1.0
    share = sum((at - foot) * value for at, foot, value in zip(middle, zero.position, axis, strict=True)) / square
    x, y, z = (foot + share * value for foot, value in zip(zero.position, axis, strict=True))
    return x, y, z
