"""Where links, and the objects that perception sees and grippers carry, really are: ground truth with its history."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial
from typing import Protocol

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3, identity
from cellc.mock.tf.sources import DeferredPose
from cellc.mock.world.joint_states import JointStateHistory
from cellc.robot.description.model import Description, Joint


class FreeBodies(Protocol):
    """Objects that nothing places: they lie, are held, and fall."""

    def moves(self, part: str) -> bool:
        """Return whether an object is one of them."""
        ...

    def pose(self, part: str, stamp_ns: int) -> Pose:
        """Return where one is at a time, in the root frame."""
        ...


@dataclass(frozen=True, slots=True)
class LinkJoint:
    """A joint of the URDF: ``origin`` in the parent link, ``axis`` of unit length in its own frame.

    The child ``moves`` in the parent or is fixed to it; it ``slides`` along the axis or turns about it. A mimic joint
    is at ``multiplier * position of follows + offset``.
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

    def displaced(self, by: Mapping[str, Pose]) -> LinkTree:
        """Return a tree in which some links stand elsewhere, seen from where they stand in this one."""
        if not by:
            return self
        moved = {link: replace(self.joints[link], origin=self.joints[link].origin @ by[link]) for link in by}
        return LinkTree({**self.joints, **moved})

    def chain(self, link: str) -> tuple[LinkJoint, ...]:
        """Return the joints from the root down to a link."""
        joints: list[LinkJoint] = []
        while link in self.joints and len(joints) <= len(self.joints):
            joints.append(self.joints[link])
            link = self.joints[link].parent
        return tuple(reversed(joints))

    def pose(self, link: str, positions: Mapping[str, float]) -> Pose:
        """Return the pose of a link in the root link."""
        pose, moving = self.run(link)
        for joint, fixed in moving:
            pose = pose @ joint.displacement(positions) @ fixed
        return pose

    def is_fixed(self, link: str) -> bool:
        """Return whether no joint moves a link."""
        return not self.run(link)[1]

    def run(self, link: str) -> tuple[Pose, tuple[tuple[LinkJoint, Pose], ...]]:
        """Return what is fixed before the first moving joint of a link, and each with what is fixed after it."""
        if link not in self._runs:
            self._runs[link] = self._merge(link)
        return self._runs[link]

    def _merge(self, link: str) -> tuple[Pose, tuple[tuple[LinkJoint, Pose], ...]]:
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


@dataclass(frozen=True, slots=True)
class Placement:
    """From ``from_ns`` on the object is at standstill in the frame of ``link``."""

    from_ns: int
    link: str
    pose: Pose


def _begin_ns(placement: Placement) -> int:
    return placement.from_ns


class World:
    """Where links and objects are at a time, computed from the recorded joint positions.

    These are measured: noise that a spec states of a joint moves its links too, by as much.
    """

    def __init__(
        self, links: LinkTree, histories: Iterable[JointStateHistory], bodies: FreeBodies | None = None
    ) -> None:
        """Bind the world to the links of the cell, the recorded joint states, and objects that move by themselves."""
        self._links = links
        self._bodies = bodies
        self._histories = tuple(histories)
        self._placements: dict[str, list[Placement]] = {}
        self._standing: dict[tuple[str, Placement], DeferredPose] = {}

    def joint_positions(self, stamp_ns: int) -> dict[str, float]:
        """Return the measured positions of all recorded joints at a time, rad or m."""
        positions: dict[str, float] = {}
        for history in self._histories:
            positions |= history.at(stamp_ns)
        return positions

    def link_pose(self, link: str, stamp_ns: int) -> Pose:
        """Return the pose of a link in the root link at a time."""
        return self._links.pose(link, self.joint_positions(stamp_ns))

    def posed(self, link: str, positions: Mapping[str, float]) -> Pose:
        """Return the pose of a link in the root link where joints are at some positions."""
        return self._links.pose(link, positions)

    def carrier_of(self, joint: str) -> str | None:
        """Return the link in which a joint moves its child; None where no joint is called so."""
        return next((item.parent for item in self._links.joints.values() if item.name == joint), None)

    def place(self, name: str, link: str, pose: Pose, now_ns: int) -> None:
        """Let an object stand still in the frame of a link from now on, unless it moves by itself."""
        self._placements.setdefault(name, []).append(Placement(now_ns, link, pose))

    def objects(self) -> tuple[str, ...]:
        """Return the names of all objects, sorted."""
        return tuple(sorted(self._placements))

    def placements(self, name: str) -> tuple[Placement, ...]:
        """Return where an object was from when on, in the order of time."""
        return tuple(self._placements[name])

    def carrier(self, name: str) -> str:
        """Return the link that an object is on or hangs from now."""
        return self._placements[name][-1].link

    def object_pose(self, name: str, stamp_ns: int) -> Pose:
        """Return the pose of an object in the root link at a time."""
        if self._bodies is not None and self._bodies.moves(name):
            return self._bodies.pose(name, stamp_ns)
        placement = self._placement(name, stamp_ns)
        return self.link_pose(placement.link, stamp_ns) @ placement.pose

    def sight(self, link: str, name: str, stamp_ns: int) -> DeferredPose:
        """Return the pose of an object in the frame of a link at a time, from what is recorded by now."""
        placement = self._placement(name, stamp_ns)
        if self._bodies is not None and self._bodies.moves(name):
            at = self._bodies.pose(name, stamp_ns)
            return DeferredPose(partial(self._seen, link, at, self.joint_positions(stamp_ns)))
        if self._links.is_fixed(link) and self._links.is_fixed(placement.link):
            if (link, placement) not in self._standing:
                self._standing[link, placement] = DeferredPose(partial(self._relative, link, placement, {}))
            return self._standing[link, placement]
        positions = self.joint_positions(stamp_ns)
        pose = DeferredPose(partial(self._relative, link, placement, positions))
        if any(map(math.isnan, positions.values())):
            pose.get()  # so that it is seen to be none
        return pose

    def _seen(self, link: str, at: Pose, positions: Mapping[str, float]) -> Pose:
        return self._links.pose(link, positions).inverse() @ at

    def _placement(self, name: str, stamp_ns: int) -> Placement:
        placements = self._placements[name]
        index = bisect_right(placements, stamp_ns, key=_begin_ns) - 1
        return placements[max(0, index)]

    def _relative(self, link: str, placement: Placement, positions: Mapping[str, float]) -> Pose:
        in_root = self._links.pose(placement.link, positions) @ placement.pose
        return self._links.pose(link, positions).inverse() @ in_root

    def move(self, name: str, link: str, now_ns: int) -> Pose:
        """Hand an object over to another link without moving it; return its pose in the frame of that link."""
        pose = self.link_pose(link, now_ns).inverse() @ self.object_pose(name, now_ns)
        self.place(name, link, pose, now_ns)
        return pose
