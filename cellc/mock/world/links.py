"""The links of the cell as the URDF joins them, and where they are for given joint positions."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from dataclasses import dataclass

from cellc.mock.errors import MockError
from cellc.transforms import Pose, Vector3, from_xyz_rpy, identity

_MOVABLE = ("revolute", "continuous", "prismatic")


@dataclass(frozen=True, slots=True)
class LinkJoint:
    """A joint of the URDF: ``origin`` in the parent link, ``axis`` of unit length in its own frame.

    A mimic joint stands at ``multiplier * position of follows + offset``.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Pose
    axis: Vector3
    follows: str | None
    multiplier: float
    offset: float

    @property
    def moves(self) -> bool:
        """Tell whether the child moves in the parent."""
        return self.kind in _MOVABLE

    def pose(self, positions: Mapping[str, float]) -> Pose:
        """Return the pose of the child link in the parent link; joints that are not named stand at zero."""
        return self.origin @ self.displacement(positions) if self.moves else self.origin

    def displacement(self, positions: Mapping[str, float]) -> Pose:
        """Return how far a moving joint has moved its child, in the frame of the joint."""
        position = self.multiplier * positions.get(self.follows or self.name, 0.0) + self.offset
        x, y, z = self.axis
        if self.kind == "prismatic":
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


def read_links(urdf: str, file: str) -> LinkTree:
    """Read the joints of a URDF; raise MockError with the name of ``file`` where a value is no pose or number."""
    try:
        root = ElementTree.fromstring(urdf)
        joints = [_joint(element) for element in root.findall("joint")]
    except ElementTree.ParseError as error:
        raise MockError(file, f"is not well-formed XML: {error}") from None
    except ValueError as error:
        raise MockError(file, str(error)) from None
    return LinkTree({joint.child: joint for joint in joints})


def _joint(element: ElementTree.Element) -> LinkJoint:
    name = element.get("name", "")
    origin, axis, mimic = element.find("origin"), element.find("axis"), element.find("mimic")
    xyz = (0.0, 0.0, 0.0) if origin is None else _triple(origin.get("xyz", "0 0 0"), name)
    rpy = (0.0, 0.0, 0.0) if origin is None else _triple(origin.get("rpy", "0 0 0"), name)
    return LinkJoint(
        name=name,
        kind=element.get("type", ""),
        parent=_link(element, "parent"),
        child=_link(element, "child"),
        origin=from_xyz_rpy(xyz, rpy),
        axis=_unit((1.0, 0.0, 0.0) if axis is None else _triple(axis.get("xyz", "1 0 0"), name)),
        follows=None if mimic is None else mimic.get("joint"),
        multiplier=1.0 if mimic is None else float(mimic.get("multiplier", "1")),
        offset=0.0 if mimic is None else float(mimic.get("offset", "0")),
    )


def _link(element: ElementTree.Element, end: str) -> str:
    found = element.find(end)
    return "" if found is None else found.get("link", "")


def _triple(text: str, joint: str) -> Vector3:
    values = [float(word) for word in text.split()]
    if len(values) != 3:
        raise ValueError(f"joint `{joint}` has `{text}` where three numbers are due")
    return (values[0], values[1], values[2])


def _unit(axis: Vector3) -> Vector3:
    length = math.sqrt(sum(part * part for part in axis))
    if length == 0.0:
        return axis
    return (axis[0] / length, axis[1] / length, axis[2] / length)
