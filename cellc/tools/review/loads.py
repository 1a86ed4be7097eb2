"""What load and tool an arm is set to, and whether something shows that it is so."""

from __future__ import annotations

import math

from cellc.contract.transforms import apart
from cellc.robot.description.posture import posture
from cellc.tools.review.carried import is_reaching
from cellc.tools.review.facts import Facts
from cellc.tools.review.geometry import moved_places
from cellc.tools.review.leaves import Delta, Leaf, Path, Prose
from cellc.tools.review.replaced import mass_of
from cellc.tools.review.units import length, quantity_of, shown

_TENTH, _SHIFT_M = 0.1, 0.05
"""Of the rated load, and how far a center of mass moves: that much is another load, and not the same weighed again."""
_MASS, _CENTER = ("mass", "mass_kg"), "center_of_mass"
_SAID_ONCE = ("frame", "set_by")
"""What says where a load is, and who sets it: it changes with no weighing."""
_ROUNDED, _NOTICED = 1e-9, 1e-6


def unexplained_load(delta: Delta, before: Facts, after: Facts) -> str | None:
    """Return why another load of an arm is dangerous; empty where its row says so, None where it is reviewed.

    A load that is weighed again differs by little. More than that is explained where the arm carries something else.
    """
    path, (was, now) = delta.path, (_figures(delta.before), _figures(delta.after))
    device = path[2] if path[0] == "check" else path[1]
    if path[:2] == ("check", "load"):
        # It is one sentence: its figures are graded where the cell states them.
        is_stated = any(key[:3] == ("device", device, "payload") for key in after.leaves)
        return None if is_stated and delta.after is not None else ""
    if delta.after is None or path[-1] in _SAID_ONCE:
        return ""
    rating = _rating(device, after)
    if path[-1] in _MASS and now and rating and now[0] > rating + _ROUNDED:
        return f"it is beyond the {shown(rating, 'kg')} that the arm may carry"
    if not was or not now or _carried(device, before) != _carried(device, after):
        return None
    if path[-1] in _MASS:
        of = min(filter(None, (rating, _rating(device, before))), default=was[0])
        told = f"a tenth of the {shown(of, 'kg')} that the arm is rated for" if rating else "a tenth"
        return f"it differs by {told} or more; {_SAME}" if abs(now[0] - was[0]) >= _TENTH * of - _ROUNDED else None
    if path[-1] == _CENTER and len(was) == len(now) and math.dist(was, now) >= _SHIFT_M - _ROUNDED:
        return f"its center moves by {length(_SHIFT_M)} or more; {_SAME}"
    return None


_SAME = "the arm carries the same devices"


def assumed_part(path: Path, facts: Facts) -> str:
    """Return where the mass comes from that a control law holds, where it is what a payload has beyond the tools."""
    if path[:2] != ("contract", "devices") or path[3:] != ("law", "part", "mass_kg") or facts.cell is None:
        return ""
    device = next((each for each in facts.cell.devices if each.name == path[2]), None)
    held = facts.leaves.get(path)
    if device is None or device.robot.payload is None or not isinstance(held, float):
        return ""
    payload, tools = device.robot.payload.mass_kg, facts.cell.carried_mass_kg(device)
    if abs(payload - tools - held) > _NOTICED:
        return ""
    told = f"what the payload of {shown(payload, 'kg')} has beyond tools of {shown(round(tools, 3), 'kg')}"
    return f"no part states another: it is {told}"


def _carried(device: str, facts: Facts) -> frozenset[tuple[str, str]]:
    """Return what is mounted on a device, with the model of each."""
    devices = facts.contract.devices
    roots = {each.root_link: name for name, each in devices.items()}
    parents = {joint.child: joint.parent for joint in facts.description.joints}
    found = set[tuple[str, str]]()
    for name, each in devices.items():
        link = parents.get(each.root_link, "")
        for _ in parents:
            if roots.get(link) == device:
                found.add((name, each.model))
            link = parents.get(link, "")
    return frozenset(found)


def _rating(device: str, facts: Facts) -> float | None:
    leaf = facts.leaves.get(("device", device, "payload_limit_kg"))
    return leaf if isinstance(leaf, float) else None


def _figures(leaf: Leaf | None) -> tuple[float, ...]:
    """Return the figures of a mass or a place in SI, in their order."""
    if isinstance(leaf, tuple):
        return tuple(float(item) for item in leaf if isinstance(item, (int, float)))
    if isinstance(leaf, (int, float)):
        return (float(leaf),)
    return quantity_of(leaf.text)[0] if isinstance(leaf, Prose) else ()


def is_measured_again(device: str, before: Facts, after: Facts) -> bool:
    """Tell whether a frame on a device has a newer calibration than before: its tool was measured again."""
    was, now = before.contract, after.contract
    newer = {
        name
        for name, each in now.calibrations.items()
        if name in was.calibrations and each.revision > was.calibrations[name].revision
    }
    parents = {name: frame.parent for name, frame in now.frames.items()}
    root = now.devices[device].root_link if device in now.devices else ""
    for name, frame in now.frames.items():
        link = name if frame.calibration in newer else ""
        for _ in parents:
            if link and link == root:
                return True
            link = parents.get(link, "")
    return False


def left_behind(device: str, before: Facts, after: Facts) -> str:
    """Return why another model is dangerous though all that measured it was measured again; empty where it is not.

    An arm that ends elsewhere in the same joint positions follows plans and poses of another one. What an arm carries
    is part of the load that it is set to.
    """
    if is_reaching(before.contract, device) or is_reaching(after.contract, device):
        return _OTHER_ARM if _ends_elsewhere(device, before, after) else ""
    for carrier in after.contract.devices:
        if all((device, _model(device, side)) in _carried(carrier, side) for side in (before, after)):
            told = _load(carrier, after)
            rating = _rating(carrier, after)
            heavier = mass_of(device, after) - mass_of(device, before)
            if told and rating and told == _load(carrier, before) and abs(heavier) >= _TENTH * rating:
                return f"the payload set for `{carrier}` was left as it was"
    return ""


_OTHER_ARM = "the arm ends elsewhere in the same joint positions"


def _ends_elsewhere(device: str, before: Facts, after: Facts) -> bool:
    """Tell whether a joint of an arm is elsewhere with all joints at zero, or a tip is in a named pose."""
    if any(place.quantity == "tip" for place in moved_places(before, after)):
        return True
    was, now = (
        {joint.name: places.get(joint.child) for joint in side.description.joints if joint.movable}
        for side in (before, after)
        for places in [posture(side.description, {})]
    )
    if was.keys() != now.keys():
        return True
    pairs = [(was[name], now[name]) for name in was]
    return any(old is None or new is None or max(apart(old, new)) > _NOTICED for old, new in pairs)


def _model(device: str, facts: Facts) -> str:
    return facts.contract.devices[device].model if device in facts.contract.devices else ""


def _load(device: str, facts: Facts) -> frozenset[tuple[str, ...]]:
    return frozenset(
        (*path, str(leaf)) for path, leaf in facts.leaves.items() if path[:3] == ("device", device, "payload")
    )
