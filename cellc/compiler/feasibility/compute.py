"""Computes the answers with the planner; imported where an answer is not in the cache."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from cellc.compiler.cell.frame import WORLD
from cellc.compiler.feasibility.answers import (
    MARGIN_M,
    RNG_SEED,
    AreaAnswer,
    BodyContact,
    DisabledAnswer,
    DisabledLinks,
    GoalAnswer,
    MotionAnswer,
    PoseAnswer,
    ViewAnswer,
)
from cellc.compiler.feasibility.question import GoalQuestion, GroupQuestion, MotionQuestion, PoseQuestion
from cellc.compiler.feasibility.weights import weighed
from cellc.contract.limits import Budget, BudgetError, limits
from cellc.contract.transforms import Pose
from cellc.robot.planning import (
    Box,
    CollisionScene,
    DisabledPair,
    DisabledReason,
    IkFailure,
    JointLimits,
    JointPath,
    LimitsError,
    ModelError,
    PlanFailure,
    Planner,
    PlanningGroup,
    RobotModel,
    beyond_reach,
    decided_collisions,
    disabled_collisions,
    meetings,
    standing_collisions,
)

IK_SEEDS = 24
"""Descents to a goal before it counts as unreachable."""
APPROACH_ATTEMPTS = 4
"""Configurations before a goal from which a straight line is tried, as many as the mock tries."""

Configuration = tuple[float, ...]


SAMPLES = 10_000
"""As many as MoveIt's Setup Assistant draws by default; fewer where many robots share a cell."""
LEAST_SAMPLES = 500
_PAIRS_TIMES_SAMPLES = 2_000_000


def sample_pairs(urdf: str, mesh_roots: Sequence[Path], budget: Budget) -> DisabledAnswer:
    """Find the pairs of a robot description that need no collision check."""
    try:
        robot = RobotModel.from_urdf(urdf, mesh_roots=mesh_roots)
    except ModelError as error:
        return DisabledAnswer((), 0, str(error))
    samples = _samples(robot)
    try:
        pairs = disabled_collisions(robot, samples=samples, rng_seed=RNG_SEED, margin_m=MARGIN_M, budget=budget)
    except BudgetError:
        return DisabledAnswer((), 0, *_too_long())
    links = tuple(DisabledLinks(pair.first, pair.second, pair.reason.value) for pair in pairs)
    return DisabledAnswer(links, samples)


_POSTURES = 4000
"""As many show what meets in one of a thousand postures, and cost half a second for a few pairs."""
_LEAST_MET, _MOST_MET = 4, 2000
"""Fewer may be a corner of two coarse shapes; more are shapes that overlap wherever the links are."""


def sample_meetings(urdf: str, pairs: Sequence[tuple[str, str]], mesh_roots: Sequence[Path] = ()) -> DisabledAnswer:
    """Find which of some pairs of links meet in postures of the joints, but not with all of them at zero."""
    try:
        robot = RobotModel.from_urdf(urdf, mesh_roots=mesh_roots)
    except ModelError as error:
        return DisabledAnswer((), 0, str(error))
    met = meetings(robot, pairs, samples=_POSTURES, rng_seed=RNG_SEED)
    links = (
        DisabledLinks(*pair, f"{count * 100.0 / _POSTURES:.2g} %")
        for pair, count in met.items()
        if _LEAST_MET <= count <= _MOST_MET
    )
    return DisabledAnswer(tuple(sorted(links)), _POSTURES)


def pairs_at_rest(urdf: str, pairs: Sequence[tuple[str, str]], mesh_roots: Sequence[Path] = ()) -> DisabledAnswer:
    """Find which of some pairs of links, between which no joint moves, touch or are neighbors in the tree."""
    try:
        robot = RobotModel.from_urdf(urdf, mesh_roots=mesh_roots)
    except ModelError as error:
        return DisabledAnswer((), 0, str(error))
    found = standing_collisions(robot, pairs, margin_m=MARGIN_M)
    return DisabledAnswer(tuple(DisabledLinks(pair.first, pair.second, pair.reason.value) for pair in found), 1)


def _too_long() -> tuple[str, str]:
    message = f"shapes and goals must take at most {limits().planning_seconds} s of processor time"
    return message, "planning-seconds"


def _samples(robot: RobotModel) -> int:
    checked = len(set(CollisionScene(robot).checked_pairs()) - beyond_reach(robot, margin_m=MARGIN_M))
    return min(SAMPLES, max(LEAST_SAMPLES, _PAIRS_TIMES_SAMPLES // max(1, checked)))


def answer(question: MotionQuestion, mesh_roots: Sequence[Path], budget: Budget) -> MotionAnswer:
    """Answer all parts of a question in the scene of the cell, every joint not asked about at its start."""
    try:
        return _answer(question, mesh_roots, budget)
    except (ModelError, LimitsError) as error:
        return MotionAnswer(refused=str(error))
    except BudgetError:
        return MotionAnswer((), (), (), *_too_long())


def _answer(question: MotionQuestion, mesh_roots: Sequence[Path], budget: Budget) -> MotionAnswer:
    scene, disabled = _scene(question, mesh_roots, budget)
    robot, start = scene.model, scene.other_positions
    asked = {goal.group for goal in question.goals}
    planners = {group.name: _planner(group, robot, scene) for group in question.groups if group.name in asked}
    poses = tuple(_pose(pose, planners, scene, start) for pose in budget.over(question.poses))
    goals = tuple(_goal(goal, planners[goal.group], robot, start) for goal in budget.over(question.goals))
    postures = _postures(question, goals, start)
    weights = weighed(question, postures, _all_planners(question, planners, robot, scene), scene, budget)
    rigid = (pair.links for pair in disabled if pair.reason is DisabledReason.ALWAYS)
    return MotionAnswer(
        start=_contacts(scene, start),
        poses=poses,
        goals=goals,
        views=_views(question, postures, robot),
        rigid=tuple(BodyContact(*links) for links in rigid),
        holding=weights.holding,
        areas=_areas(question, postures, scene),
        droops=weights.droops,
        outside=weights.outside,
        on_paths=weights.on_paths,
        tips=weights.tips,
        tips_on_paths=weights.tips_on_paths,
    )


def _all_planners(
    question: MotionQuestion, known: Mapping[str, Planner], robot: RobotModel, scene: CollisionScene
) -> dict[str, Planner]:
    return {group.name: known.get(group.name) or _planner(group, robot, scene) for group in question.groups}


def _scene(
    question: MotionQuestion, mesh_roots: Sequence[Path], budget: Budget
) -> tuple[CollisionScene, tuple[DisabledPair, ...]]:
    """Return the scene of the cell at its start, and the pairs that the shapes alone take out of it."""
    robot = RobotModel.from_urdf(question.urdf, mesh_roots=mesh_roots)
    start = {joint: value for joint, value in question.start if joint in robot.joints}
    samples = _samples(robot)
    disabled = decided_collisions(robot, samples=samples, rng_seed=RNG_SEED, margin_m=MARGIN_M, budget=budget)
    unchecked = [*(pair.links for pair in disabled), *question.allowed]
    return CollisionScene(robot, disabled_collisions=unchecked, other_positions=start), disabled


def planner_of(question: MotionQuestion, group: str, mesh_roots: Sequence[Path] = ()) -> Planner:
    """Return the planner of one group in the scene of the cell.

    Raises:
        ModelError, LimitsError, BudgetError: the shapes or joints cannot be looked at, or take too long.
    """
    scene, _ = _scene(question, mesh_roots, Budget(limits().planning_seconds, time.process_time))
    return _planner(next(item for item in question.groups if item.name == group), scene.model, scene)


def _pose(
    pose: PoseQuestion, planners: Mapping[str, Planner], scene: CollisionScene, start: Mapping[str, float]
) -> PoseAnswer:
    """Return what touches in a named pose, and how near the groups that have goals are to a singularity."""
    positions = {**start, **dict(pose.positions)}
    placed = dict(pose.positions)
    least = tuple(
        (name, planner.min_singular_value([placed[joint] for joint in planner.limits.joints]))
        for name, planner in planners.items()
        if all(joint in placed for joint in planner.limits.joints)
    )
    return PoseAnswer(pose.name, _contacts(scene, positions), least)


def _postures(
    question: MotionQuestion, goals: Sequence[GoalAnswer], start: Mapping[str, float]
) -> Mapping[str, Mapping[str, float]]:
    """Return all joints in each pose, and at each goal that the arm can get to; the empty name is where they begin."""
    joints = {group.name: group.joints for group in question.groups}
    groups = {goal.name: goal.group for goal in question.goals}
    postures = {"": dict(start)} | {pose.name: {**start, **dict(pose.positions)} for pose in question.poses}
    for goal in goals:
        if goal.configuration:
            taken = dict(zip(joints[groups[goal.name]], goal.configuration, strict=True))
            postures.setdefault(goal.name, {**start, **taken})
    return postures


def _views(
    question: MotionQuestion, postures: Mapping[str, Mapping[str, float]], robot: RobotModel
) -> tuple[ViewAnswer, ...]:
    """Return where each detected object is for its camera; nothing where the arm cannot get to look."""
    answers = []
    for view in question.views:
        positions = postures.get(view.posture)
        if positions is not None:
            camera = robot.link_pose(view.camera_frame, _movable(robot, positions), base_link=WORLD)
            place = (camera.inverse() @ view.place).position
            answers.append(ViewAnswer(view.name, view.camera_frame, view.posture, place))
    return tuple(answers)


def _areas(
    question: MotionQuestion, postures: Mapping[str, Mapping[str, float]], scene: CollisionScene
) -> tuple[AreaAnswer, ...]:
    """Return what is in each shared volume, posture by posture."""
    answers = []
    for area in question.areas:
        box = Box(f"area {area.name}", area.link, area.size, area.pose)
        for name, positions in postures.items():
            links = scene.touching(box, scene.model.configuration(_movable(scene.model, positions)))
            answers.append(AreaAnswer(area.name, name, links))
    return tuple(answers)


def _movable(robot: RobotModel, positions: Mapping[str, float]) -> dict[str, float]:
    return {joint: value for joint, value in positions.items() if joint in robot.joints}


def _planner(group: GroupQuestion, robot: RobotModel, scene: CollisionScene) -> Planner:
    # No time is planned here: any limits of speed do.
    free = (1.0,) * len(group.joints)
    limits = JointLimits(group.joints, group.lower, group.upper, free, free, free)
    return Planner(robot, PlanningGroup(group.name, group.joints, group.base_link, group.tip_link), limits, scene)


def _contacts(scene: CollisionScene, positions: Mapping[str, float]) -> tuple[BodyContact, ...]:
    movable = scene.model.configuration(_movable(scene.model, positions))
    return tuple(BodyContact(*pair) for pair in scene.contacts(movable))


def _goal(goal: GoalQuestion, planner: Planner, robot: RobotModel, start: Mapping[str, float]) -> GoalAnswer:
    base_in_world = robot.link_pose(planner.group.base_link, start, base_link=WORLD)
    target = base_in_world.inverse() @ goal.target
    begin = tuple(start.get(joint, 0.0) for joint in planner.group.joints)
    solution = planner.inverse_kinematics(target, begin, seeds=IK_SEEDS)
    if isinstance(solution, IkFailure):
        return GoalAnswer(goal.name, failure=solution.reason.value, detail=solution.detail)
    if goal.before is None:
        return _margins(goal.name, planner, solution.configuration)
    line = _approach(planner, base_in_world.inverse() @ goal.before, target, begin)
    if isinstance(line, str):
        return GoalAnswer(goal.name, approach_failure=line)
    return _margins(goal.name, planner, line)


def _approach(planner: Planner, before: Pose, target: Pose, begin: Configuration) -> Configuration | str:
    """Return the configuration at the end of a straight line to the goal, or why the first attempt had none."""
    first = ""
    for attempt in range(APPROACH_ATTEMPTS):
        solution = planner.inverse_kinematics(before, begin, rng_seed=attempt)
        if isinstance(solution, IkFailure):
            first = first or f"before the approach {solution.detail}"
            continue
        line = planner.plan_cartesian(solution.configuration, target)
        if isinstance(line, JointPath):
            return line.goal
        assert isinstance(line, PlanFailure)
        first = first or line.detail
    return first


def _margins(name: str, planner: Planner, configuration: Configuration) -> GoalAnswer:
    nearest = ("", 1.0, 0.0)
    limits = planner.limits
    for joint, value, lower, upper in zip(limits.joints, configuration, limits.lower, limits.upper, strict=True):
        distance = min(value - lower, upper - value)
        if distance < nearest[1] * (upper - lower):
            nearest = (joint, distance / (upper - lower), distance)
    least = planner.min_singular_value(configuration)
    return GoalAnswer(
        name,
        min_singular_value=least,
        limit_joint=nearest[0],
        limit_share=nearest[1],
        limit_distance=nearest[2],
        configuration=tuple(map(float, configuration)),
    )
