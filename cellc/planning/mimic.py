"""Joints that follow other joints.

Bound here and not by pinocchio, which wants a leader before its followers in a tree that its parser has sorted by name:
a gripper whose follower has the lesser name would be refused.
"""

from __future__ import annotations

from dataclasses import dataclass

from cellc.description.model import Description
from cellc.planning.failure import ModelError


@dataclass(frozen=True, slots=True)
class Mimic:
    """A joint that stands at ``multiplier * leader + offset``; the leader itself follows nothing."""

    joint: str
    leader: str
    multiplier: float
    offset: float


def resolve_mimics(description: Description) -> tuple[Mimic, ...]:
    """Return the mimic joints in the order of the file; a mimic of a mimic is led by the joint at the end.

    Raises:
        ModelError: the joint followed does not exist or is fixed, or joints follow each other in a circle.
    """
    types = {joint.name: joint.type for joint in description.joints}
    direct = {
        joint.name: Mimic(joint.name, joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
        for joint in description.joints
        if joint.mimic is not None
    }
    for mimic in direct.values():
        if mimic.leader not in types:
            raise ModelError(f"joint `{mimic.joint}` mimics `{mimic.leader}`, which does not exist")
        if types[mimic.leader] == "fixed":
            raise ModelError(f"joint `{mimic.joint}` mimics `{mimic.leader}`, which is fixed")
    return tuple(_resolve(mimic, direct) for mimic in direct.values())


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
