"""Where frames, tips and goals stand by the description and the contract of a package: forward kinematics."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from cellc.contract.transforms import Pose, apart, climb, identity
from cellc.robot.description.posture import posture
from cellc.tools.review.facts import Facts
from cellc.tools.review.units import motion

_NOTICED = 1e-6
"""m and rad."""


@dataclass(frozen=True, slots=True)
class Moved:
    """A tip in a named pose, or a goal, that moved in the root frame without an edit of its own keys."""

    subject: str
    quantity: str
    before: Pose
    after: Pose


def moved_places(before: Facts, after: Facts) -> Iterator[Moved]:
    """Yield tips in named poses and goals that both sides have and that stand elsewhere after the change.

    A goal that moved in its frame alone is left out: its own pose tells that.
    """
    yield from _moved("tip", _tips(before), _tips(after))
    was, now = _goal_frames(before), _goal_frames(after)
    moved = [name for name in was if name in now and max(apart(was[name], now[name])) > _NOTICED]
    yield from _moved(
        "place in the root frame",
        {name: was[name] @ before.contract.goals[name].pose.pose for name in moved},
        {name: now[name] @ after.contract.goals[name].pose.pose for name in moved},
    )


def moved_bases(before: Facts, after: Facts, bases: Collection[str]) -> Iterator[Moved]:
    """Yield bases of arms that stand elsewhere because what carries them is another, with joints at zero.

    A base that moved in its own parent is left out, and what is mounted on one that moved: its pose tells that.
    """
    was, now = _carried(before, bases), _carried(after, bases)
    for name in was:
        if name in now and max(apart(was[name][0], now[name][0])) > _NOTICED:
            old, new = _mount(before, name), _mount(after, name)
            if old is None or new is None or max(apart(old, new)) <= _NOTICED:
                yield Moved(name, "base in the root frame", was[name][1], now[name][1])


def _mount(facts: Facts, link: str) -> Pose | None:
    return next((joint.pose for joint in facts.description.joints if joint.child == link), None)


def place_difference(frame: str, before: Facts, after: Facts) -> str:
    """Return how far a frame moves on what carries it, where its parent moves as well; empty where that stays.

    What carries it is the nearest link below it that a joint moves, else the root.
    """
    was, now = on_carrier(frame, before), on_carrier(frame, after)
    old, new = _stated(frame, before), _stated(frame, after)
    if was is None or now is None or old is None or new is None or was[0] != now[0]:
        return ""
    in_parent, whole = apart(old, new), apart(was[1], now[1])
    if _parent(frame, before) != _parent(frame, after):
        return f"{motion(*whole) or 'stays'} on {was[0]}"
    if max(abs(one - other) for one, other in zip(in_parent, whole, strict=True)) <= _NOTICED:
        return ""
    return f"{motion(*whole) or 'stays'} on {was[0]}; in its parent {motion(*in_parent)}"


def _parent(frame: str, facts: Facts) -> str | None:
    joint = next((each for each in facts.description.joints if each.child == frame), None)
    stated = facts.contract.frames.get(frame)
    return joint.parent if joint is not None else None if stated is None else stated.parent


def _stated(frame: str, facts: Facts) -> Pose | None:
    stated = facts.contract.frames.get(frame)
    return _mount(facts, frame) or (None if stated is None or stated.pose is None else stated.pose.pose)


def on_carrier(frame: str, facts: Facts) -> tuple[str, Pose] | None:
    """Return the nearest link that moves, or the root, with the pose of a frame in it."""
    joints = {joint.child: joint for joint in facts.description.joints}
    place = identity()
    for _ in range(len(joints) + len(facts.contract.frames)):
        pose, joint = _stated(frame, facts), joints.get(frame)
        if pose is None:
            return frame, place
        place = pose @ place
        frame = facts.contract.frames[frame].parent if joint is None else joint.parent
        above = joints.get(frame)
        if above is not None and above.movable:
            return frame, place
    return None


def _carried(facts: Facts, bases: Collection[str]) -> dict[str, tuple[Pose, Pose]]:
    """Return the pose of each base in the base below it, or in the root, and that in the root."""
    links = posture(facts.description, {})
    parents = {joint.child: joint.parent for joint in facts.description.joints}
    carried = {}
    for base in bases:
        pose, below = links.get(base), parents.get(base)
        for _ in parents:
            if below is None or below in bases:
                break
            below = parents.get(below)
        under = identity() if below is None else links.get(below)
        if pose is not None and under is not None:
            carried[base] = (under.inverse() @ pose, pose)
    return carried


def _moved(quantity: str, was: Mapping[str, Pose], now: Mapping[str, Pose]) -> Iterator[Moved]:
    for name in was:
        if name in now and max(apart(was[name], now[name])) > _NOTICED:
            yield Moved(name, quantity, was[name], now[name])


def _tips(facts: Facts) -> dict[str, Pose]:
    """Return where the tip of each group is in each named pose, in the root frame."""
    poses = {}
    for name, targets in facts.contract.poses.items():
        links = posture(facts.description, _positions(facts, name))
        for target in targets:
            group = facts.contract.groups.get(target.group)
            pose = None if group is None else _place(facts, group.tip_frame, links)
            if pose is not None:
                poses[f"{target.group} in {name}"] = pose
    return poses


def _goal_frames(facts: Facts) -> dict[str, Pose]:
    """Return the frame of each goal in the root frame, with joints at zero and dynamic frames as on the mock."""
    links = posture(facts.description, {})
    frames = {name: _place(facts, goal.frame, links) for name, goal in facts.contract.goals.items()}
    return {name: frame for name, frame in frames.items() if frame is not None}


def _positions(facts: Facts, name: str) -> Mapping[str, float]:
    positions: dict[str, float] = {}
    for target in facts.contract.poses[name]:
        group = facts.contract.groups.get(target.group)
        if group is not None and len(group.joints) == len(target.positions):
            positions.update(zip(group.joints, target.positions, strict=True))
    return positions


def _place(facts: Facts, frame: str, links: Mapping[str, Pose]) -> Pose | None:
    """Return the pose of a frame in the root of the tree; None where no chain leads there.

    Args:
        links: pose of each link in the root link of the description, which is its first.
    """
    root_link = next(iter(links), None)

    def edge(child: str) -> tuple[str, Pose] | None:
        stated = facts.contract.frames.get(child)
        if root_link is not None and child in links and child != root_link:
            return root_link, links[child]
        if stated is not None and stated.pose is not None:
            return stated.parent, stated.pose.pose
        if stated is not None and stated.simulated_pose is not None and stated.simulated_parent is not None:
            return stated.simulated_parent, stated.simulated_pose.pose
        return None

    top, pose = climb(frame, edge, (facts.contract.root_frame,))
    return pose if top == facts.contract.root_frame else None
