"""Motion planning of one rehearsal: named poses and Cartesian goals in, timed trajectories or reasons out.

A goal with an approach is reached on a straight line from the pose before it, and left on the same line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.mock.nodes.motion_model import GroupModel, MotionModel
from cellc.mock.planning import (
    CollisionScene,
    IkFailure,
    JointPath,
    LimitsError,
    PlanFailure,
    Planner,
    TimedTrajectory,
    time_parameterize,
)
from cellc.mock.planning.failure import FailureReason
from cellc.transforms import Pose, Vector3

PLANNING_LATENCY_S = 0.05
"""Simulated time charged for every plan, whatever the host needs, so that a run is the same on every machine."""
OBJECT_EDGE_M = 0.02
"""Edge of the box that stands for a grasped object in collision checks: the contract states no size."""
_IK_ATTEMPTS = 4


@dataclass(frozen=True, slots=True)
class PlannedMotion:
    """A trajectory of a group; ``retreat`` is the tip link's pose in the base from which the goal was approached."""

    trajectory: TimedTrajectory
    retreat: Pose | None


@dataclass(frozen=True, slots=True)
class GoalPose:
    """A goal of the tip frame in the group's base link; the approach is in the tip's own axes, m."""

    tip_in_base: Pose
    approach: Vector3 | None


class MotionPlanner:
    """Plans in a scene that follows what the gripper carries."""

    def __init__(self, model: MotionModel, rng_seed: int) -> None:
        """Bind the planner of one run; the same seed gives the same plans."""
        self._model = model
        self._scene = model.scene
        self._rng_seed = rng_seed

    def attach(self, name: str, link: str, pose_in_link: Pose, positions: Mapping[str, float]) -> None:
        """Let a grasped object move with a link; it may touch the gripper and what carries it now."""
        edge = (OBJECT_EDGE_M, OBJECT_EDGE_M, OBJECT_EDGE_M)
        scene = self._scene.attach(name, link, edge, pose_in_link)
        at = self._model.robot.configuration(self._independent(positions))
        touching = {other for pair in scene.contacts(at) if name in pair for other in pair} - {name}
        carried = {child for child in self._model.links.joints if self._hangs_from(child, link)}
        known = set(self._model.robot.links)
        self._scene = scene.allow_touch(name, sorted((touching | carried | {link}) & known))

    def detach(self, name: str) -> None:
        """Forget a released object."""
        self._scene = self._scene.detach(name)

    def plan_pose(
        self, group: str, positions: Mapping[str, float], target: tuple[float, ...], retreat: Pose | None
    ) -> PlannedMotion | PlanFailure:
        """Plan to joint positions of a group, first back along ``retreat`` where the arm stands at a goal."""
        model, planner = self._model.groups[group], self._planner(group, positions)
        begun = self._begin(planner, positions, retreat)
        if isinstance(begun, PlanFailure):
            return begun
        start, path = begun
        onward = planner.plan_to_configuration(start, target, rng_seed=self._rng_seed)
        if isinstance(onward, PlanFailure):
            return onward
        return _timed(model, onward if path is None else path.then(onward), None)

    def plan_goal(
        self, group: str, positions: Mapping[str, float], goal: GoalPose, retreat: Pose | None
    ) -> PlannedMotion | PlanFailure:
        """Plan to a Cartesian goal over the pose before it."""
        model, planner = self._model.groups[group], self._planner(group, positions)
        begun = self._begin(planner, positions, retreat)
        if isinstance(begun, PlanFailure):
            return begun
        start, path = begun
        first_failure: PlanFailure | None = None
        for attempt in range(_IK_ATTEMPTS):
            onward = self._reach(model, planner, start, goal, self._rng_seed + attempt)
            if isinstance(onward, JointPath):
                before = None if goal.approach is None else _link_pose(model, _before(goal))
                return _timed(model, onward if path is None else path.then(onward), before)
            first_failure = first_failure or onward
        assert first_failure is not None  # the loop ran at least once
        return first_failure

    def _reach(
        self, model: GroupModel, planner: Planner, start: tuple[float, ...], goal: GoalPose, rng_seed: int
    ) -> JointPath | PlanFailure:
        solution = planner.inverse_kinematics(_link_pose(model, _before(goal)), start, rng_seed=rng_seed)
        if isinstance(solution, IkFailure):
            return PlanFailure(solution.reason, solution.detail)
        transit = planner.plan_to_configuration(start, solution.configuration, rng_seed=rng_seed)
        if isinstance(transit, PlanFailure) or goal.approach is None:
            return transit
        line = planner.plan_cartesian(transit.goal, _link_pose(model, goal.tip_in_base))
        return line if isinstance(line, PlanFailure) else transit.then(line)

    def _begin(
        self, planner: Planner, positions: Mapping[str, float], retreat: Pose | None
    ) -> tuple[tuple[float, ...], JointPath | None] | PlanFailure:
        """Return where the transit starts and the path to there."""
        start = tuple(positions[joint] for joint in planner.group.joints)
        if retreat is None:
            return start, None
        path = planner.plan_cartesian(start, retreat)
        return path if isinstance(path, PlanFailure) else (path.goal, path)

    def _planner(self, group: str, positions: Mapping[str, float]) -> Planner:
        planner = self._model.groups[group].planner
        own = set(planner.group.joints)
        others = {name: value for name, value in self._independent(positions).items() if name not in own}
        return planner.in_scene(self._scene_at(others))

    def _scene_at(self, others: Mapping[str, float]) -> CollisionScene:
        return self._scene.with_other_positions(others)

    def _independent(self, positions: Mapping[str, float]) -> dict[str, float]:
        return {name: value for name, value in positions.items() if name in self._model.robot.joints}

    def _hangs_from(self, link: str, ancestor: str) -> bool:
        return any(joint.parent == ancestor for joint in self._model.links.chain(link))


def _timed(model: GroupModel, path: JointPath, retreat: Pose | None) -> PlannedMotion | PlanFailure:
    try:
        return PlannedMotion(time_parameterize(path, model.planner.limits), retreat)
    except LimitsError as error:
        return PlanFailure(FailureReason.OUT_OF_LIMITS, str(error))


def _before(goal: GoalPose) -> Pose:
    """Return the pose of the tip before the approach; the goal itself where there is none."""
    if goal.approach is None:
        return goal.tip_in_base
    return goal.tip_in_base @ Pose(goal.approach, (0.0, 0.0, 0.0, 1.0))


def _link_pose(model: GroupModel, tip_in_base: Pose) -> Pose:
    return tip_in_base @ model.transform_tip_to_link.inverse()
