"""One question to the planner and its answer: a pure function, so that an answer may be kept and given again."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from cellc.mock.nodes.motion_model import GroupModel, MotionModel
from cellc.planning import (
    Box,
    CollisionScene,
    FailureReason,
    IkFailure,
    JointPath,
    LimitsError,
    PlanFailure,
    Planner,
    TimedTrajectory,
    time_parameterize,
)
from cellc.transforms import Pose, Vector3

_IK_ATTEMPTS = 4
"""Configurations tried before a goal: the straight approach is not possible from every one."""
_KEPT_SCENES = 4


@dataclass(frozen=True, slots=True)
class SceneState:
    """What differs from the empty scene: carried objects, and the pairs that may touch because of them."""

    boxes: tuple[Box, ...] = ()
    allowed: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class GoalPose:
    """A goal of the tip frame in the group's base link; the approach is in the tip's own axes, m."""

    tip_in_base: Pose
    approach: Vector3 | None


@dataclass(frozen=True, slots=True)
class MotionRequest:
    """Everything that a plan depends on.

    Attributes:
        start: positions of the group's joints, rad or m.
        others: positions of all other independent joints, sorted by name.
        goal: joint positions of the group, or a pose of its tip.
        retreat: pose of the tip link in the base to which the arm goes back first, on a straight line.
    """

    group: str
    start: tuple[float, ...]
    others: tuple[tuple[str, float], ...]
    scene: SceneState
    goal: tuple[float, ...] | GoalPose
    retreat: Pose | None
    rng_seed: int


@dataclass(frozen=True, slots=True)
class PlannedMotion:
    """A trajectory of a group; ``retreat`` is the tip link's pose in the base from which the goal was approached."""

    trajectory: TimedTrajectory
    retreat: Pose | None


def plan_motion(model: MotionModel, request: MotionRequest) -> PlannedMotion | PlanFailure:
    """Plan: back along the retreat, across to the goal or before it, and straight on to it."""
    group = model.groups[request.group]
    planner = group.planner.in_scene(build_scene(model, request.scene, request.others))
    back = None if request.retreat is None else planner.plan_cartesian(request.start, request.retreat)
    if isinstance(back, PlanFailure):
        return back
    start = request.start if back is None else back.goal
    if isinstance(request.goal, GoalPose):
        onward = _to_goal(group, planner, start, request.goal, request.rng_seed)
        before = None if request.goal.approach is None else _link_pose(group, _before(request.goal))
    else:
        onward = planner.plan_to_configuration(start, request.goal, rng_seed=request.rng_seed)
        before = None
    if isinstance(onward, PlanFailure):
        return onward
    try:
        path = onward if back is None else back.then(onward)
        return PlannedMotion(time_parameterize(path, planner.limits), before)
    except LimitsError as error:
        return PlanFailure(FailureReason.OUT_OF_LIMITS, str(error))


def build_scene(model: MotionModel, state: SceneState, others: tuple[tuple[str, float], ...]) -> CollisionScene:
    """Return the scene of a request."""
    return _scene_of(model, state).with_other_positions(dict(others))


@lru_cache(maxsize=_KEPT_SCENES)
def _scene_of(model: MotionModel, state: SceneState) -> CollisionScene:
    """Return the scene with all joints outside the group at rest; kept, since motions in a row share it."""
    if state == SceneState():
        return model.scene
    disabled = (*model.scene.disabled_collisions, *state.allowed)
    return CollisionScene(model.robot, disabled_collisions=disabled, boxes=state.boxes)


def _to_goal(
    group: GroupModel, planner: Planner, start: tuple[float, ...], goal: GoalPose, rng_seed: int
) -> JointPath | PlanFailure:
    """Try one configuration before the goal after the other; the failure of the first is the one that is told."""
    first = _reach(group, planner, start, goal, rng_seed)
    if isinstance(first, JointPath):
        return first
    for attempt in range(1, _IK_ATTEMPTS):
        path = _reach(group, planner, start, goal, rng_seed + attempt)
        if isinstance(path, JointPath):
            return path
    return first


def _reach(
    group: GroupModel, planner: Planner, start: tuple[float, ...], goal: GoalPose, rng_seed: int
) -> JointPath | PlanFailure:
    solution = planner.inverse_kinematics(_link_pose(group, _before(goal)), start, rng_seed=rng_seed)
    if isinstance(solution, IkFailure):
        return PlanFailure(solution.reason, solution.detail)
    transit = planner.plan_to_configuration(start, solution.configuration, rng_seed=rng_seed)
    if isinstance(transit, PlanFailure) or goal.approach is None:
        return transit
    line = planner.plan_cartesian(transit.goal, _link_pose(group, goal.tip_in_base))
    return line if isinstance(line, PlanFailure) else transit.then(line)


def _before(goal: GoalPose) -> Pose:
    """Return the pose of the tip before the approach; the goal itself where there is none."""
    if goal.approach is None:
        return goal.tip_in_base
    return goal.tip_in_base @ Pose(goal.approach, (0.0, 0.0, 0.0, 1.0))


def _link_pose(group: GroupModel, tip_in_base: Pose) -> Pose:
    return tip_in_base @ group.transform_tip_to_link.inverse()
