"""A device that another model replaces: its parts follow the model, and what counts of the model is measured.

Joints and links that only one of the two models has are one change, not one each: nothing of them was left without
limits or shapes, and no other client commands them.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from cellc.contract.vocabulary import Grade, ReviewArea
from cellc.robot.description.model import Description
from cellc.robot.description.posture import posture
from cellc.tools.review.carried import is_reaching
from cellc.tools.review.change import Change
from cellc.tools.review.covering import corners_of
from cellc.tools.review.facts import Facts

_FEW = 3
_APART = re.compile(r"[\s/.,]+")
MASS, LENGTH, SHAPES = "mass in the description", "length from the mount", "shapes"
PAIRS = ("can now meet", "can no longer meet")
"""What is said of two links of which a collision is checked that was not, and in the other direction."""
CLAIM, PARTS, INERTIA = "controller that claims it", "links and joints", "inertia of its links"
_OF_BODY = ("collision shapes added", "collision shapes removed", "mass and inertia added", "mass and inertia removed")


@dataclass(frozen=True, slots=True)
class Replaced:
    """A device with another model.

    Attributes:
        links: of either model.
        bare: those of them that collide on one side alone.
        gone: links and joints of the model before alone.
        come: links and joints of the model after alone.
    """

    device: str
    links: frozenset[str]
    bare: frozenset[str]
    gone: frozenset[str]
    come: frozenset[str]


def replaced(before: Facts, after: Facts) -> Iterator[Replaced]:
    """Yield the devices that have another model."""
    for name, was in before.contract.devices.items():
        now = after.contract.devices.get(name)
        if now is None or now.model == was.model:
            continue
        (old_links, old_joints), (new_links, new_joints) = (_body(name, side) for side in (before, after))
        gone = (old_links | old_joints) - _names(after.description)
        come = (new_links | new_joints) - _names(before.description)
        links = old_links | new_links
        yield Replaced(name, links, links & (_colliding(before) ^ _colliding(after)), gone, come)


def _colliding(facts: Facts) -> frozenset[str]:
    return frozenset(link.name for link in facts.description.links if link.collisions)


def _names(body: Description) -> frozenset[str]:
    return frozenset((*(link.name for link in body.links), *(joint.name for joint in body.joints)))


def joints_of(device: str, facts: Facts) -> frozenset[str]:
    """Return the joints of a device, without those of what is mounted on it."""
    return _body(device, facts)[1]


def _body(device: str, facts: Facts) -> tuple[frozenset[str], frozenset[str]]:
    """Return the links and the joints of a device, without what is mounted on it."""
    others = {each.root_link for name, each in facts.contract.devices.items() if name != device}
    links, joints = {facts.contract.devices[device].root_link}, set[str]()
    for _ in facts.description.joints:
        below = [each for each in facts.description.joints if each.parent in links and each.child not in links | others]
        if not below:
            break
        links |= {each.child for each in below}
        joints |= {each.name for each in below}
    return frozenset(links), frozenset(joints)


@dataclass(frozen=True, slots=True)
class Measured:
    """What the links of a device weigh in kg, how far they reach in m, or how many shapes of which kind they have.

    Attributes:
        before: None of a device that is new.
        after: None of a device that is gone.
        counted: of a mass, how many of its links have one on each side, and of how many with a shape.
    """

    device: str
    quantity: str
    before: float | str | None
    after: float | str | None
    counted: tuple[tuple[int, int], tuple[int, int]] = ((0, 0), (0, 0))


def measured_of(before: Facts, after: Facts) -> Iterator[Measured]:
    """Yield what the links of devices weigh that have another model or that come or go; of what is no arm its size."""
    devices = [each.device for each in replaced(before, after)]
    for device in (*devices, *sorted(before.contract.devices.keys() ^ after.contract.devices.keys())):
        there = [side for side in (before, after) if device in side.contract.devices]
        links = [_body(device, side)[0] if side in there else frozenset[str]() for side in (before, after)]
        sides = [*zip((before, after), links, strict=True)]
        counted = [_counted(side.description, of) for side, of in sides]
        was, now = (round(_mass(side.description, of), 3) or None for side, of in sides)
        if was != now and (len(there) == 1 or None not in (was, now)):
            yield Measured(device, MASS, was, now, (counted[0], counted[1]))
        if any(is_reaching(side.contract, device) for side in there):
            continue
        was, now = (round(_length(side, device, of), 4) or None if of else None for side, of in sides)
        if was != now and (len(there) == 1 or None not in (was, now)):
            yield Measured(device, LENGTH, was, now)
        shapes = [_shapes(side.description, of) for side, of in sides]
        if shapes[0] != shapes[1]:
            yield Measured(device, SHAPES, shapes[0], shapes[1])


def _shapes(body: Description, links: Collection[str]) -> str | None:
    """Return how many collision shapes of each kind links have; None of none."""
    shapes = [shape for link in body.links if link.name in links for shape in link.collisions]
    kinds = Counter(type(shape.geometry).__name__.lower() for shape in shapes)
    told = (f"{number} {kind}{_PLURAL[kind] * (number > 1)}" for kind, number in sorted(kinds.items()))
    return " and ".join(told) or None


_PLURAL = {"box": "es", "mesh": "es", "cylinder": "s", "sphere": "s"}


def mass_of(device: str, facts: Facts) -> float:
    """Return what the links of a device weigh in the description, in kg."""
    return _mass(facts.description, _body(device, facts)[0])


def _mass(body: Description, links: Collection[str]) -> float:
    return sum(link.inertial.mass for link in body.links if link.name in links and link.inertial is not None)


def _counted(body: Description, links: Collection[str]) -> tuple[int, int]:
    """Return how many links have a mass, and how many have one or a shape."""
    solid = [link for link in body.links if link.name in links and (link.inertial or link.collisions or link.visuals)]
    return sum(link.inertial is not None for link in solid), len(solid)


def _length(facts: Facts, device: str, links: Collection[str]) -> float:
    """Return how far shapes get from where a device is mounted, with joints at zero; 0 where a mesh is among them."""
    places = posture(facts.description, {})
    root = places.get(facts.contract.devices[device].root_link)
    farthest = 0.0
    for link in facts.description.links:
        if root is None or link.name not in links or link.name not in places:
            continue
        for shape in link.collisions:
            corners = [*corners_of(shape.geometry)]
            if not corners:
                return 0.0
            place = root.inverse() @ places[link.name] @ shape.pose
            farthest = max(farthest, *(math.hypot(*place.apply(corner)) for corner in corners))
    return farthest


def with_models(changes: Sequence[Change], before: Facts, after: Facts) -> list[Change]:
    """Return changes with those of parts that follow from another model as one for each device."""
    left = list(changes)
    edited = before.edited | after.edited
    for each in replaced(before, after):
        held = {change.before for change in left if change.quantity == CLAIM and change.before is not None}
        following = [change for change in left if _follows(change, each, held, edited)]
        left = [change for change in left if change not in following]
        if following and (each.gone or each.come):
            left.append(_parts(each, following))
        elif following:
            left.append(Change(ReviewArea.MODEL, each.device, INERTIA, "those before", "others", Grade.REVIEW))
    return left


def _parts(each: Replaced, following: Sequence[Change]) -> Change:
    breaking = any(change.breaking for change in following)
    return Change(
        ReviewArea.FRAMES if breaking else ReviewArea.MODEL,
        each.device,
        PARTS,
        _listed(each.gone),
        _listed(each.come),
        Grade.REVIEW,
        breaking=breaking,
        why="consumers outside the cell know the frames of the links by name" if breaking else "",
    )


def _listed(names: Collection[str]) -> str | None:
    more = f" and {len(names) - _FEW} more" if len(names) > _FEW else ""
    return f"{', '.join(sorted(names)[:_FEW])}{more}" if names else None


def _follows(change: Change, each: Replaced, held: Collection[str | None], edited: Collection[str]) -> bool:
    if change.quantity == CLAIM:
        return bool(_parted(change.subject) & (each.gone | each.come)) and change.after in (None, *held)
    if change.area is ReviewArea.MODEL and change.subject in ("urdf/real", "urdf/mock"):
        return not edited
    if change.quantity in PAIRS:
        return not each.bare.isdisjoint(change.subject.split(" with "))
    if change.quantity in _OF_BODY:
        return change.subject in each.links
    if change.quantity.startswith("inertia") and change.area is ReviewArea.MODEL:
        return change.subject in each.links and change.subject not in edited
    was, now = _parted(change.before), _parted(change.after)
    if was - now and now - was:
        return was - now <= each.gone and now - was <= each.come
    named = _parted(f"{change.subject} {change.quantity}")
    return bool(named & (each.gone | each.come))


def _parted(text: str | None) -> set[str]:
    """Return the names that a text holds; what a joint's interface is called is no name."""
    return {part for part in _APART.split(text or "") if part} - {"position", "velocity", "effort", "acceleration"}
