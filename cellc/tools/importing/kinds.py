"""What a robot is to a cell, by the evidence of its description: a table of signs, each with the reason that it gives.

A sign that is not certain becomes a question in ``device.yaml``; `cellc import --kind` decides.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

from cellc.contract.diagnostics.wording import count
from cellc.robot.description.model import Description, Joint
from cellc.robot.description.posture import posture

_FINGER_WORDS = re.compile(r"finger|thumb|jaw|knuckle|claw|gripper|grasp|suction|vacuum", re.IGNORECASE)
_WHEEL_WORDS = re.compile(r"wheel|caster", re.IGNORECASE)
_FINGER_M = 0.25
"""A branch of joints that reaches farther than this from its palm is not a finger."""
_LIMB = 4
"""A chain of this many joints, fingers left out, is an arm."""
_LEVEL = 0.3
"""An axis is level where its upward part is at most this."""


@dataclass(frozen=True, slots=True)
class Kind:
    """What a robot is, why, and whether the evidence is certain."""

    kind: str
    because: str
    certain: bool = True


@dataclass(frozen=True, slots=True)
class Shape:
    """What the joints of a description look like.

    Attributes:
        wheels: joints of wheels and casters.
        fingers: the first joint of each finger of the first palm.
        driving: the joints of the fingers that mimic none.
        limbs: chains of joints from the root that end before fingers, wheels left out, the longest first.
    """

    wheels: tuple[Joint, ...]
    fingers: tuple[Joint, ...]
    driving: tuple[Joint, ...]
    limbs: tuple[tuple[Joint, ...], ...]


def kind_of(description: Description) -> Kind:
    """Return what a robot is by the first sign that holds."""
    shape = shape_of(description)
    return next(kind for sign in _SIGNS if (kind := sign(shape)) is not None)


def _base(shape: Shape) -> Kind | None:
    longest = len(shape.limbs[0]) if shape.limbs else 0
    if len(shape.wheels) < 2 or longest >= _LIMB:
        return None
    return Kind("base", f"{len(shape.wheels)} wheels, `{shape.wheels[0].name}` first", longest <= 2)


def _hand(shape: Shape) -> Kind | None:
    fingers, joints = len(shape.fingers), len(shape.driving)
    if (shape.limbs and len(shape.limbs[0]) >= _LIMB) or fingers < 3 or joints < 3:
        return None
    return Kind(
        "hand", f"{fingers} fingers with {joints} joints on `{shape.fingers[0].parent}`", fingers > 3 or joints > 6
    )


def _gripper(shape: Shape) -> Kind | None:
    if (shape.limbs and len(shape.limbs[0]) >= _LIMB) or not shape.fingers:
        return None
    fingers = {2: "two fingers", 3: "three fingers"}.get(len(shape.fingers), f"{len(shape.fingers)} branches")
    if len(shape.driving) == 1:
        others = "one mimics the other" if len(shape.fingers) == 2 else f"all mimic `{shape.driving[0].name}`"
        return Kind("gripper", f"{fingers}, {others}")
    return Kind("gripper", f"{fingers}, and {len(shape.driving)} joints that mimic none", certain=False)


def _named_gripper(shape: Shape) -> Kind | None:
    joints = shape.limbs[0] if len(shape.limbs) == 1 else ()
    named = next((joint for joint in joints if _is_finger(joint)), None)
    if named is None or len(joints) > 2:
        return None
    return Kind("gripper", f"the name of `{named.name}` or of its link is that of a gripper's part", certain=False)


def _axis(shape: Shape) -> Kind | None:
    if len(shape.limbs) == 1 and all(joint.slides for joint in shape.limbs[0]):
        return Kind("axis", f"all its joints slide, {len(shape.limbs[0])} in a row")
    if len(shape.limbs) == 1 and len(shape.limbs[0]) == 1:
        return Kind("axis", f"`{shape.limbs[0][0].name}` turns, and nothing else moves", certain=False)
    return None


def _arm(shape: Shape) -> Kind | None:
    long = [limb for limb in shape.limbs if len(limb) >= _LIMB]
    if not long:
        return None
    because = f"a chain of {len(long[0])} joints"
    if len(long) > 1:
        return Kind("arm", f"{because}, and {len(long) - 1} more of {_LIMB} or more", certain=False)
    return Kind("arm", f"{because}, on {len(shape.wheels)} wheels" if shape.wheels else because, not shape.wheels)


def _anything(shape: Shape) -> Kind:
    joints = len(shape.limbs[0]) if shape.limbs else 0
    return Kind("arm", f"a chain of {count(joints, 'joint')}, and no sign of anything else", certain=False)


_SIGNS: tuple[Callable[[Shape], Kind | None], ...] = (_base, _hand, _gripper, _named_gripper, _axis, _arm, _anything)
"""In the order in which they are asked."""


def shape_of(description: Description) -> Shape:
    """Return what the joints of a description look like."""
    tree = _Tree(description)
    wheels = _wheels(tree)
    palms = [link for link in tree.bodies if _is_palm(link, tree, wheels)]
    fingers = tuple(joint for palm in palms[:1] for joint in tree.below[palm] if joint not in wheels)
    paths = [tuple(path) for path in tree.paths() if path[-1] not in wheels]
    limbs = {_limb(path, palms, tree) for path in paths}
    return Shape(
        wheels=wheels,
        fingers=fingers,
        driving=tuple(joint for first in fingers for joint in tree.under(first) if joint.mimic is None),
        limbs=tuple(sorted(filter(None, limbs), key=lambda limb: (-len(limb), limb[0].name, limb[-1].name))),
    )


class _Tree:
    """Bodies, each the links that no joint moves against each other, and the joints that move below each.

    Attributes:
        bodies: the first link of each, from the root on.
        below: body → the joints that move on it.
        reach: body → how far the joints below it lie from it at most, along the links, m.
    """

    def __init__(self, description: Description) -> None:
        self.description = description
        self.body: dict[str, str] = {}
        self.below: dict[str, list[Joint]] = {}
        children: dict[str, list[Joint]] = {}
        for joint in description.joints:
            children.setdefault(joint.parent, []).append(joint)
        waiting: list[tuple[str, str, Joint | None]] = [(root, root, None) for root in description.roots()[:1]]
        while waiting:
            link, body, above = waiting.pop(0)
            if link in self.body:  # in a loop, which a rule reports
                continue
            self.body[link] = body
            if above is not None and above.movable:
                self.below.setdefault(self.body[above.parent], []).append(above)
            waiting += (
                (joint.child, joint.child if joint.movable else body, joint) for joint in children.get(link, ())
            )
        self.bodies = tuple(dict.fromkeys(self.body.values()))
        self.reach: dict[str, float] = {}
        for body in reversed(self.bodies):
            below = self.below.get(body, ())
            self.reach[body] = max(
                (math.hypot(*joint.pose.position) + self.reach[joint.child] for joint in below), default=0
            )

    def under(self, joint: Joint) -> list[Joint]:
        """Return a joint that moves and all that move below it."""
        joints = [joint]
        for above in joints:
            joints += self.below.get(above.child, ())
        return joints

    def paths(self) -> list[list[Joint]]:
        """Return the joints that move from the root to each body on which none moves."""
        waiting = [[joint] for root in self.bodies[:1] for joint in self.below.get(root, ())]
        ended = []
        while waiting:
            path = waiting.pop(0)
            longer = [[*path, joint] for joint in self.below.get(path[-1].child, ())]
            waiting += longer
            if not longer:
                ended.append(path)
        return ended


def _wheels(tree: _Tree) -> tuple[Joint, ...]:
    """Return the last joints of chains that are wheels: by name, or continuous about a level axis of the root."""
    poses = posture(tree.description, {})
    wheels = []
    for path in tree.paths():
        last = path[-1]
        x, y, z = last.axis
        out = poses[last.child].apply((x, y, z))
        level = abs(out[2] - poses[last.child].position[2]) <= _LEVEL * (math.hypot(x, y, z) or 1.0)
        named = is_wheel(last)
        rolls = last.type == "continuous" and len(path) == 1 and level and not _is_finger(last)
        if rolls or (named and not last.slides):
            wheels.append(last)
    return tuple(wheels) if len(wheels) > 1 else ()


def is_wheel(joint: Joint) -> bool:
    """Tell whether the name of a joint or of its link is that of a wheel."""
    return _WHEEL_WORDS.search(f"{joint.name} {joint.child}") is not None


def is_jaw(joint: Joint) -> bool:
    """Tell whether the name of a joint is that of a part of a gripper; that of its link may be of what carries one."""
    return _FINGER_WORDS.search(joint.name) is not None


def _is_finger(joint: Joint) -> bool:
    return _FINGER_WORDS.search(f"{joint.name} {joint.child}") is not None


def _is_palm(body: str, tree: _Tree, wheels: tuple[Joint, ...]) -> bool:
    """Tell whether several chains of joints hang on a body, all of them as short as fingers."""
    branches = [joint for joint in tree.below.get(body, ()) if joint not in wheels]
    return len(branches) > 1 and all(tree.reach[joint.child] <= _FINGER_M for joint in branches)


def _limb(path: tuple[Joint, ...], palms: list[str], tree: _Tree) -> tuple[Joint, ...]:
    """Return the joints of a path that mimic none, up to the first palm, or to a jaw at its end."""
    limb = []
    for joint in path:
        if tree.body[joint.parent] in palms:
            break
        limb.append(joint)
    while len(limb) >= _LIMB and is_jaw(limb[-1]):
        limb.pop()
    return tuple(joint for joint in limb if joint.mimic is None)
