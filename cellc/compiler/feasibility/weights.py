"""Torques and droop of joints in poses, at goals and on the paths of rehearsals; imported by ``compute`` alone."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise

import numpy as np

from cellc.compiler.feasibility.answers import BodyContact, DroopAnswer, HoldingAnswer, TipAnswer
from cellc.compiler.feasibility.question import GroupQuestion, MotionQuestion
from cellc.contract.frozen import dataclass
from cellc.contract.limits import Budget
from cellc.robot.planning import CollisionScene, JointPath, Load, Planner, RobotModel, Springs, Weights
from cellc.robot.planning.problem import Array

_STEP = 0.05
"""Rad or m of the joint that moves most from one place to the next that is looked at on a path."""
_ALIKE = 1e-9
"""Rad or m: by less, no place is worse than another, whatever the last bits of both are."""

Positions = Mapping[str, float]


@dataclass(frozen=True, slots=True)
class _At:
    """Where the joints are: a posture, or a place on the way of a group from it; with the devices that hold a part."""

    posture: str
    towards: str
    holding: tuple[str, ...]
    positions: Positions
    group: str = ""


@dataclass(frozen=True, slots=True)
class Weighed:
    """What joints must give, and how far those behind springs droop."""

    holding: tuple[HoldingAnswer, ...]
    droops: tuple[DroopAnswer, ...]
    on_paths: tuple[DroopAnswer, ...]
    outside: tuple[DroopAnswer, ...]
    tips: tuple[TipAnswer, ...]
    tips_on_paths: tuple[TipAnswer, ...]


def weighed(
    question: MotionQuestion,
    postures: Mapping[str, Positions],
    planners: Mapping[str, Planner],
    scene: CollisionScene,
    budget: Budget,
) -> Weighed:
    """Weigh a cell in all postures, and on the paths that rehearsals take between them.

    Args:
        postures: all joints by the name of a pose or goal; the empty name is where the cell begins.
        planners: of every group.
    """
    robot = scene.model
    paths = list(_paths(question, postures, planners, budget))
    visits = [
        _At(visit.posture, "", visit.holding, postures[visit.posture])
        for visit in question.visits
        if visit.posture in postures
    ]
    alone = [_At(name, "", (), positions) for name, positions in postures.items()]
    start = _At("", "", (), postures[""])
    at_rest = list(_at_rest(question, visits, robot))
    return Weighed(
        holding=_holding(question, (*alone, *paths), robot),
        droops=_worst(one for one, _ in at_rest),
        on_paths=_worst(one for one, _ in _at_rest(question, paths, robot)),
        outside=_worst(_outside(question, (*at_rest, *_at_rest(question, (start,), robot)))),
        tips=tuple(_tips(question, visits, scene)),
        tips_on_paths=tuple(_first_contacts(_tips(question, paths, scene))),
    )


def _paths(
    question: MotionQuestion, postures: Mapping[str, Positions], planners: Mapping[str, Planner], budget: Budget
) -> Iterator[_At]:
    """Yield places on the paths of rehearsals; where no path is found between two postures, on the straight one."""
    taken = {
        (visit.before, visit.posture, visit.holding)
        for visit in question.visits
        if visit.before in postures and visit.posture in postures
    }
    for before, posture, holding in budget.over(sorted((one or "", two, held) for one, two, held in taken)):
        start, end = postures[before], postures[posture]
        for group in question.groups:
            for configuration in _path(group, planners[group.name], start, end):
                placed = dict(zip(group.joints, configuration, strict=True))
                yield _At(before, posture, holding, {**start, **placed}, group.name)


def _path(group: GroupQuestion, planner: Planner, start: Positions, end: Positions) -> Iterator[tuple[float, ...]]:
    first, last = (tuple(at.get(joint, 0.0) for joint in group.joints) for at in (start, end))
    if first == last:
        return
    others = {joint: value for joint, value in start.items() if joint in planner.model.joints}
    path = planner.in_scene(planner.scene.with_other_positions(others)).plan_to_configuration(first, last)
    corners = [first, *(section[-1] for section in path.sections)] if isinstance(path, JointPath) else [first, last]
    for one, other in pairwise(corners):
        steps = max(1, math.ceil(max(abs(a - b) for a, b in zip(one, other, strict=True)) / _STEP))
        for step in range(1, steps):
            yield tuple(a + (b - a) * step / steps for a, b in zip(one, other, strict=True))


def _holding(question: MotionQuestion, places: Iterable[_At], robot: RobotModel) -> tuple[HoldingAnswer, ...]:
    """Return the most that holds each joint which has a limit of effort."""
    held = tuple(joint for joint in question.held if joint in robot.joints)
    weights = Weights(robot, robot.joints, question.carried)
    most: dict[str, HoldingAnswer] = {}
    for at in places:
        positions = [at.positions.get(joint, robot.rest_of(joint)) for joint in robot.joints]
        efforts = dict(zip(robot.joints, weights.efforts(np.array(positions)).tolist(), strict=True))
        for joint in held:
            effort = round(abs(efforts[joint]), 6)
            if joint not in most or effort > most[joint].effort:
                most[joint] = HoldingAnswer(joint, effort, at.posture, at.towards)
    return tuple(most.values())


def _settled(question: MotionQuestion, at: _At, robot: RobotModel) -> Iterator[tuple[Springs, Array, Array]]:
    """Yield the springs of each device with where its joints are commanded, and where they come to rest."""
    for law in question.laws:
        springs = Springs(law.law, robot, Load(holds=law.device in at.holding), at.positions)
        commanded = np.array([at.positions.get(joint, 0.0) for joint in springs.joints])
        yield springs, commanded, springs.balance(commanded)


def _at_rest(question: MotionQuestion, places: Iterable[_At], robot: RobotModel) -> Iterator[tuple[DroopAnswer, float]]:
    """Yield how far each joint behind a spring droops in each place, and where it is then, rad or m."""
    for at in places:
        place = at.posture, at.towards, bool(at.holding)
        for springs, commanded, rest in _settled(question, at, robot):
            efforts = springs.held(springs.efforts(rest)).tolist()
            droops = (commanded - rest).tolist()
            for joint, droop, effort, here in zip(springs.joints, droops, efforts, rest.tolist(), strict=True):
                yield DroopAnswer(joint, round(droop, 9), round(effort, 9), *place), here


def _worst(droops: Iterable[DroopAnswer]) -> tuple[DroopAnswer, ...]:
    most: dict[str, DroopAnswer] = {}
    for droop in droops:
        if droop.joint not in most or abs(droop.droop) > abs(most[droop.joint].droop) + _ALIKE:
            most[droop.joint] = droop
    return tuple(most.values())


def _outside(question: MotionQuestion, at_rest: Iterable[tuple[DroopAnswer, float]]) -> Iterator[DroopAnswer]:
    """Yield the places in which a joint is farther outside its limits than a motion may begin."""
    bounds = {
        joint: (lower - question.start_outside - _ALIKE, upper + question.start_outside + _ALIKE)
        for group in question.groups
        for joint, lower, upper in zip(group.joints, group.lower, group.upper, strict=True)
    }
    for one, here in at_rest:
        lower, upper = bounds.get(one.joint, (-math.inf, math.inf))
        if not lower <= here <= upper:
            yield one


def _tips(question: MotionQuestion, places: Iterable[_At], scene: CollisionScene) -> Iterator[TipAnswer]:
    """Yield where the tips of groups with springs come to rest, in each different place."""
    held = {joint for law in question.laws for joint in law.law.joints}
    groups = [group for group in question.groups if not held.isdisjoint(group.joints)]
    seen = set[tuple[object, ...]]()
    for at in places if groups else ():
        place = at.posture, at.towards, at.holding, *at.positions.values()
        if place in seen:
            continue
        seen.add(place)
        rest = dict(at.positions)
        for springs, _, settled in _settled(question, at, scene.model):
            rest |= zip(springs.joints, settled.tolist(), strict=True)
        meets = _contacts(scene, rest)
        planned = _contacts(scene, at.positions) if meets else ()
        more = tuple(contact for contact in meets if contact not in planned)
        yield from (_tip(group, at, rest, scene.model, more) for group in groups if at.group in ("", group.name))


def _first_contacts(tips: Iterable[TipAnswer]) -> Iterator[TipAnswer]:
    """Yield the first place with contacts of each path and group."""
    seen: set[tuple[str, str, str, bool]] = set()
    for tip in tips:
        path = tip.group, tip.posture, tip.towards, tip.holding
        if tip.contacts and path not in seen:
            seen.add(path)
            yield tip


def _tip(
    group: GroupQuestion, at: _At, rest: Positions, robot: RobotModel, contacts: tuple[BodyContact, ...]
) -> TipAnswer:
    root = robot.links[0]
    wanted, real = (
        robot.link_pose(group.tip_link, _movable(robot, positions), base_link=root) @ group.transform_tip_to_link
        for positions in (at.positions, rest)
    )
    distance_m = math.dist(wanted.position, real.position)
    below_m = wanted.position[2] - real.position[2]
    figures = round(distance_m, 9), round(below_m, 9)
    return TipAnswer(group.name, at.posture, bool(at.holding), *figures, contacts, at.towards)


def _contacts(scene: CollisionScene, positions: Positions) -> tuple[BodyContact, ...]:
    configuration = scene.model.configuration(_movable(scene.model, positions))
    return tuple(BodyContact(*pair) for pair in scene.contacts(configuration))


def _movable(robot: RobotModel, positions: Positions) -> dict[str, float]:
    return {joint: value for joint, value in positions.items() if joint in robot.joints}
