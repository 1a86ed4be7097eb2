"""What gates read of the robot description itself, without the parts that execute it."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass

_MOVABLE = ("revolute", "continuous", "prismatic")


@dataclass(frozen=True, slots=True)
class DescribedJoint:
    """A joint as the URDF has it; limits in rad or m, None where there is none.

    Attributes:
        axis_length: length of the axis as written; 1 where none is.
    """

    name: str
    kind: str
    parent: str
    child: str
    axis_length: float
    lower: float | None
    upper: float | None
    velocity: float | None

    @property
    def moves(self) -> bool:
        """Tell whether it has a degree of freedom."""
        return self.kind in _MOVABLE


@dataclass(frozen=True, slots=True)
class Description:
    """Links, joints, and the plugin of each hardware component."""

    links: tuple[str, ...]
    joints: tuple[DescribedJoint, ...]
    plugins: dict[str, str]

    def roots(self) -> tuple[str, ...]:
        """Return the links that no joint carries."""
        carried = {joint.child for joint in self.joints}
        return tuple(link for link in self.links if link not in carried)

    def unreached(self, root: str) -> tuple[str, ...]:
        """Return the links that cannot be reached from a root, cycles included."""
        children: dict[str, list[str]] = {}
        for joint in self.joints:
            children.setdefault(joint.parent, []).append(joint.child)
        reached, waiting = set[str](), [root]
        while waiting:
            link = waiting.pop()
            if link not in reached:
                reached.add(link)
                waiting += children.get(link, [])
        return tuple(link for link in self.links if link not in reached)


def read_description(urdf: str) -> Description:
    """Read a URDF that the mock has loaded before, so that it is known to be well-formed."""
    root = ElementTree.fromstring(urdf)
    return Description(
        links=tuple(link.get("name", "") for link in root.findall("link")),
        joints=tuple(_joints(root)),
        plugins={
            component.get("name", ""): (component.findtext("hardware/plugin") or "").strip()
            for component in root.findall("ros2_control")
        },
    )


def _joints(root: ElementTree.Element) -> Iterator[DescribedJoint]:
    for joint in root.findall("joint"):
        axis, limit = joint.find("axis"), joint.find("limit")
        yield DescribedJoint(
            name=joint.get("name", ""),
            kind=joint.get("type", ""),
            parent=_link(joint, "parent"),
            child=_link(joint, "child"),
            axis_length=1.0 if axis is None else math.hypot(*map(float, axis.get("xyz", "1 0 0").split())),
            lower=_number(limit, "lower"),
            upper=_number(limit, "upper"),
            velocity=_number(limit, "velocity"),
        )


def _link(joint: ElementTree.Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _number(limit: ElementTree.Element | None, name: str) -> float | None:
    text = None if limit is None else limit.get(name)
    return None if text is None else float(text)
