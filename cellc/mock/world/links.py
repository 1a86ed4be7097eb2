"""The links of the cell as the URDF joins them, and where they are for given joint positions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from cellc.description.model import Description, Joint
from cellc.transforms import Pose, Vector3, identity


@dataclass(frozen=True, slots=True)
class LinkJoint:
    """A joint of the URDF: ``origin`` in the parent link, ``axis`` of unit length in its own frame.

    The child ``moves`` in the parent or is fixed to it; it ``slides`` along the axis or turns about it. A mimic joint
    stands at ``multiplier * position of follows + offset``.
    """

    name: str
    moves: bool
    slides: bool
    parent: str
    child: str
    origin: Pose
    axis: Vector3
    follows: str | None
    multiplier: float
    offset: float

    def pose(self, positions: Mapping[str, float]) -> Pose:
        """Return the pose of the child link in the parent link; joints that are not named stand at zero."""
        return self.origin @ self.displacement(positions) if self.moves else self.origin

    def displacement(self, positions: Mapping[str, float]) -> Pose:
        """Return how far a moving joint has moved its child, in the frame of the joint."""
        position = self.multiplier * positions.get(self.follows or self.name, 0.0) + self.offset
        x, y, z = self.axis
        if self.slides:
            return Pose((x * position, y * position, z * position), (0.0, 0.0, 0.0, 1.0))
        sine = math.sin(position / 2.0)
        return Pose((0.0, 0.0, 0.0), (x * sine, y * sine, z * sine, math.cos(position / 2.0)))


class LinkTree:
    """The joints of a URDF by their child link."""

    def __init__(self, joints: Mapping[str, LinkJoint]) -> None:
        self.joints = joints
        self._runs: dict[str, tuple[Pose, tuple[tuple[LinkJoint, Pose], ...]]] = {}

    def chain(self, link: str) -> tuple[LinkJoint, ...]:
        """Return the joints from the root down to a link."""
        joints: list[LinkJoint] = []
        while link in self.joints and len(joints) <= len(self.joints):
            joints.append(self.joints[link])
            link = self.joints[link].parent
        return tuple(reversed(joints))

    def pose(self, link: str, positions: Mapping[str, float]) -> Pose:
        """Return the pose of a link in the root link."""
        pose, moving = self._run(link)
        for joint, fixed in moving:
            pose = pose @ joint.displacement(positions) @ fixed
        return pose

    def stands(self, link: str) -> bool:
        """Tell whether no joint moves a link."""
        return not self._run(link)[1]

    def _run(self, link: str) -> tuple[Pose, tuple[tuple[LinkJoint, Pose], ...]]:
        if link not in self._runs:
            self._runs[link] = self._merge(link)
        return self._runs[link]

    def _merge(self, link: str) -> tuple[Pose, tuple[tuple[LinkJoint, Pose], ...]]:
        """Return what is fixed before the first moving joint, and each moving joint with what is fixed after it."""
        first = identity()
        moving: list[tuple[LinkJoint, Pose]] = []
        for joint in self.chain(link):
            if moving:
                moving[-1] = (moving[-1][0], moving[-1][1] @ joint.origin)
            else:
                first = first @ joint.origin
            if joint.moves:
                moving.append((joint, identity()))
        return first, tuple(moving)


def link_tree(description: Description) -> LinkTree:
    """Return the joints of a robot description as a tree of links."""
    return LinkTree({joint.child: _link_joint(joint) for joint in description.joints})


def _link_joint(joint: Joint) -> LinkJoint:
    return LinkJoint(
        name=joint.name,
        moves=joint.movable,
        slides=joint.type == "prismatic",
        parent=joint.parent,
        child=joint.child,
        origin=joint.pose,
        axis=_unit(joint.axis),
        follows=None if joint.mimic is None else joint.mimic.joint,
        multiplier=1.0 if joint.mimic is None else joint.mimic.multiplier,
        offset=0.0 if joint.mimic is None else joint.mimic.offset,
    )


def _unit(axis: Vector3) -> Vector3:
    length = math.sqrt(sum(part * part for part in axis))
    if length == 0.0:
        return axis
    return (axis[0] / length, axis[1] / length, axis[2] / length)
