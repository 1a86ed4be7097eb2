"""Links of an arm that carry its tips: where one is longer, every joint position ends elsewhere."""

from __future__ import annotations

import math

from cellc.contract.contract import Contract
from cellc.tools.review.facts import Facts
from cellc.tools.review.units import length, shown

_REACHING = ("arm", "axis")
"""Kinds of devices that carry what they hold to other places."""
_NOTICED = 1e-6
"""m."""
ENDS_ELSEWHERE = "every joint position and plan ends elsewhere"
"""How the reason ends of a link that is another one."""


def is_reaching(contract: Contract, device: str) -> bool:
    """Tell whether a device takes what it holds to other places, as an arm does."""
    return device in contract.devices and contract.devices[device].kind in _REACHING


def longer_link(link: str, before: Facts, after: Facts) -> str:
    """Return what another origin of a joint means, where it carries a tip of an arm of the same model; else nothing."""
    device = _device_of(link, before)
    was, now = before.contract.devices.get(device), after.contract.devices.get(device)
    if was is None or now is None or was.model != now.model or device != _device_of(link, after):
        return ""
    frame = before.contract.frames.get(link)
    if frame is not None and frame.kind != "link":
        return ""  # a frame of the cell, and no link of the arm
    if not is_reaching(before.contract, device) or not (_carries_tip(link, before) and _carries_tip(link, after)):
        return ""
    old, new = (next(each for each in side.description.joints if each.child == link) for side in (before, after))
    sides = [math.hypot(*joint.pose.position) for joint in (old, new)]
    grown = sides[1] - sides[0]
    if abs(grown) <= _NOTICED:
        return f"origin of joint `{new.name}` moves: {ENDS_ELSEWHERE}"
    by = f"`{new.parent}` {length(abs(grown))} {'longer' if grown > 0 else 'shorter'}"
    return f"{by}, origin of joint `{new.name}` {shown(sides[0], 'm')} -> {shown(sides[1], 'm')}: {ENDS_ELSEWHERE}"


def _device_of(link: str, facts: Facts) -> str:
    """Return the device that a link is a part of, other than as its root; empty where there is no such device."""
    roots = {device.root_link: name for name, device in facts.contract.devices.items()}
    parents = {joint.child: joint.parent for joint in facts.description.joints}
    if link in roots:
        return ""
    for _ in parents:
        link = parents.get(link, "")
        if link in roots:
            return roots[link]
    return ""


def _carries_tip(link: str, facts: Facts) -> bool:
    """Tell whether a link is on the way from a joint that moves to the tip of a planning group."""
    parents = {joint.child: joint.parent for joint in facts.description.joints}
    for group in facts.contract.groups.values():
        at = group.tip_frame
        for _ in range(len(parents) + len(facts.contract.frames)):
            if at == link:
                return True
            stated = facts.contract.frames.get(at)
            at = parents.get(at) or ("" if stated is None else stated.parent or "")
            if not at:
                break
    return False
