"""Joints that follow other joints.

Bound here and not by pinocchio, which wants a leader before its followers in a tree that its parser has sorted by name:
a gripper whose follower has the lesser name would be refused.
"""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass

from cellc.planning.failure import ModelError


@dataclass(frozen=True, slots=True)
class Mimic:
    """A joint that stands at ``multiplier * leader + offset``; the leader itself follows nothing."""

    joint: str
    leader: str
    multiplier: float
    offset: float


def read_mimics(text: str) -> tuple[Mimic, ...]:
    """Read the mimic joints of a URDF in document order; a mimic of a mimic is led by the joint at the end.

    Raises:
        ModelError: the joint followed does not exist or is fixed, joints follow each other in a circle, or a factor is
            no number.
    """
    joints = {joint.get("name", ""): joint for joint in ElementTree.fromstring(text).findall("joint")}
    elements = ((name, joint.find("mimic")) for name, joint in joints.items())
    direct = {name: _read(name, element) for name, element in elements if element is not None}
    for mimic in direct.values():
        if mimic.leader not in joints:
            raise ModelError(f"joint `{mimic.joint}` mimics `{mimic.leader}`, which does not exist")
        if joints[mimic.leader].get("type") == "fixed":
            raise ModelError(f"joint `{mimic.joint}` mimics `{mimic.leader}`, which is fixed")
    return tuple(_resolve(mimic, direct) for mimic in direct.values())


def _read(name: str, element: ElementTree.Element) -> Mimic:
    try:
        multiplier, offset = float(element.get("multiplier", "1")), float(element.get("offset", "0"))
    except ValueError as error:
        raise ModelError(f"the mimic of joint `{name}` has no number where one is needed: {error}") from None
    return Mimic(name, element.get("joint", ""), multiplier, offset)


def _resolve(mimic: Mimic, direct: dict[str, Mimic]) -> Mimic:
    multiplier, offset, leader = mimic.multiplier, mimic.offset, mimic.leader
    for _ in direct:
        above = direct.get(leader)
        if above is None:
            return Mimic(mimic.joint, leader, multiplier, offset)
        offset += multiplier * above.offset
        multiplier *= above.multiplier
        leader = above.leader
    if leader not in direct:
        return Mimic(mimic.joint, leader, multiplier, offset)
    raise ModelError(f"joint `{mimic.joint}` mimics itself over `{mimic.leader}`")
