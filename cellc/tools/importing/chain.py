"""Which joints of a description move as one chain, and where each begins and goes: what a first motion needs."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from cellc.robot.description.model import Description, Joint, JointLimit
from cellc.tools.importing.kinds import is_jaw
from cellc.tools.importing.source import ImportRefusedError

_SHARE = 0.1
"""Of the way to the farther limit: what the first motion moves a joint."""
_LARGEST = {True: 0.05, False: 0.2}
"""By whether a joint slides: the most that it moves, m or rad."""
_HANDS = 3
"""A link that this many joints carry, and that several branches of joints hang on, is the palm of a hand."""

_TIP_NAMES = tuple(
    re.compile(rf"(^|[_/])({name})(_link|_frame)?$", re.IGNORECASE)
    for name in ("tool0", "ee|eef|end_effector", "tcp", "tool|tool_tip", "gripper_frame|grasp|grasping", "flange")
)
"""Names of links that carry tools, the one that counts first in front; what vendors call them."""


@dataclass(frozen=True, slots=True)
class Chain:
    """A run of joints between two links, each with a range; names are those of the description."""

    base: str
    tip: str
    joints: tuple[Joint, ...]


def actuated(description: Description) -> tuple[Joint, ...]:
    """Return the joints that move on their own."""
    return tuple(joint for joint in description.joints if joint.movable and joint.mimic is None)


def chain_of(description: Description) -> Chain:
    """Return the longest chain of joints that can be planned for, without the fingers at its end.

    Raises:
        ImportRefusedError: no joint moves.
    """
    parents = {joint.child: joint for joint in description.joints}
    chains = [_above(link.name, parents) for link in description.links]
    runs = [run for chain in chains for run in _runs(chain)]
    longest = max(runs, key=lambda run: len(run.joints), default=None)
    if longest is None:
        raise ImportRefusedError(f"`{description.name}` has no joint that can move: {_held(description)}")
    chain = _without_fingers(longest, description)
    return replace(chain, tip=tip_at(chain.tip, description).link)


def _held(description: Description) -> str:
    """Say what keeps every joint from moving, with the first as the example."""
    joints = actuated(description)
    if not joints:
        return _fixed(description) if description.joints else "it has no joints"
    first, limit = joints[0], joints[0].limit or JointLimit(None, None, None, None)
    wrong = limit.velocity if limit.velocity is not None and limit.velocity < 0.0 else None
    lower, upper = _ends(first)
    why = f"a velocity of {wrong:g}" if wrong is not None else f"the range {lower:g} to {upper:g}"
    more = f", and {len(joints) - 1} more" if joints[1:] else ""
    return f"`{first.name}` has {why}{more}; correct its `<limit>`"


def _fixed(description: Description) -> str:
    """Say which joint the description limits and fixes all the same: its type is the mistake."""
    why = "its joints are fixed, or mimic each other"
    limited = next((joint.name for joint in description.joints if joint.type == "fixed" and joint.limit), None)
    return why if limited is None else f"{why}; `{limited}` is fixed and has a `<limit>`, correct its type"


def home_of(joint: Joint) -> float:
    """Return the position of a joint nearest zero that its limits hold."""
    lower, upper = _ends(joint)
    return min(max(0.0, lower), upper)


def away_of(joint: Joint) -> float:
    """Return a position a little way from home, towards the farther limit."""
    home, (lower, upper) = home_of(joint), _ends(joint)
    way = upper - home if upper - home >= home - lower else lower - home
    most = _LARGEST[joint.slides]
    return round(home + max(-most, min(most, _SHARE * way)), 6)


def back_of(joint: Joint) -> float:
    """Return a position a little way from home, towards the nearer limit; home itself where that is the limit."""
    home, (lower, upper) = home_of(joint), _ends(joint)
    return round(min(max(2.0 * home - away_of(joint), lower), upper), 6)


def range_of(joint: Joint) -> float:
    """Return how far a joint moves, rad or m; a turn where it has no ends."""
    lower, upper = _ends(joint)
    return upper - lower


def _ends(joint: Joint) -> tuple[float, float]:
    limit = joint.limit
    if joint.type == "continuous" or limit is None or limit.lower is None or limit.upper is None:
        return (-3.14, 3.14)
    return (limit.lower, limit.upper)


def _above(link: str, parents: Mapping[str, Joint]) -> tuple[Joint, ...]:
    """Return the joints from the root to a link; as far as a cycle where there is one."""
    joints: list[Joint] = []
    while link in parents and parents[link] not in joints:
        joints.append(parents[link])
        link = parents[link].parent
    return tuple(reversed(joints))


def _runs(chain: tuple[Joint, ...]) -> list[Chain]:
    """Split a chain where a joint cannot be planned for, and leave out what does not move."""
    runs, run, base = list[Chain](), list[Joint](), ""
    for joint in chain:
        plannable = joint.movable and joint.mimic is None and _has_way(joint)
        if plannable:
            base, run = (base or joint.parent), [*run, joint]
        elif joint.type != "fixed":
            runs, run, base = [*runs, *_ended(base, run)], [], ""
    return [*runs, *_ended(base, run)]


def _ended(base: str, run: list[Joint]) -> list[Chain]:
    return [Chain(base, run[-1].child, tuple(run))] if run else []


def _has_way(joint: Joint) -> bool:
    limit = joint.limit
    if limit is None or not limit.velocity or limit.velocity < 0.0:
        return False
    return joint.type == "continuous" or (limit.lower is not None and limit.upper is not None and range_of(joint) > 0.0)


def _without_fingers(chain: Chain, description: Description) -> Chain:
    """End a chain at the palm: where several branches move, or where what is left slides or is named as jaws are."""
    below: dict[str, list[Joint]] = {}
    for joint in description.joints:
        below.setdefault(joint.parent, []).append(joint)
    for count in range(_HANDS, len(chain.joints)):
        finger = chain.joints[count]
        branches = sum(_moves(joint, below) for joint in below[finger.parent])
        if branches > 1 or finger.slides or is_jaw(finger):
            return Chain(chain.base, finger.parent, chain.joints[:count])
    last = chain.joints[-1]
    if len(chain.joints) > _HANDS and not _named(chain.tip, description) and _named(last.parent, description):
        return Chain(chain.base, last.parent, chain.joints[:-1])
    return chain


def _moves(joint: Joint, below: Mapping[str, list[Joint]]) -> bool:
    waiting, seen = [joint], set[str]()
    while waiting:
        checked = waiting.pop()
        if checked.movable:
            return True
        if checked.child not in seen:
            seen.add(checked.child)
            waiting += below.get(checked.child, [])
    return False


@dataclass(frozen=True, slots=True)
class Tip:
    """The link at the end of a chain that carries tools, or where fingers close; why, and whether that is certain."""

    link: str
    because: str
    certain: bool = True


def tip_at(link: str, description: Description) -> Tip:
    """Return the tip of what a link carries without joints, by its name, or else the last frame."""
    named = _named(link, description)
    if named:
        return Tip(named, "it is named as a tool frame")
    carried, last = _carried(link, description), link
    while len(carried[last]) == 1:
        (last,) = carried[last]
    return Tip(last, "it is the last link, and none is named as a tool frame", certain=False)


def _named(link: str, description: Description) -> str:
    """Return the link with the name of a tool frame that a link is or carries; empty if no link has one."""
    carried = _carried(link, description)
    named = ([name for name in carried if pattern.search(name)] for pattern in _TIP_NAMES)
    return next((names[0] for names in named if names), "")


def _carried(link: str, description: Description) -> dict[str, list[str]]:
    """Return the links that fixed joints join below a link, itself too, nearest first, each with those on it."""
    carried: dict[str, list[str]] = {link: []}
    for parent in (waiting := [link]):
        for joint in description.joints:
            if joint.type == "fixed" and joint.parent == parent and joint.child not in carried:
                carried[parent].append(joint.child)
                carried[joint.child] = []
                waiting.append(joint.child)
    return carried
