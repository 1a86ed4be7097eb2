"""The planner of one group in one scene: goals in, paths or reasons out."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from cellc.contract.transforms import Pose
from cellc.robot.planning.cartesian import plan_line
from cellc.robot.planning.chain import GroupChain
from cellc.robot.planning.inverse_kinematics import IkSolution, singular_values, solve_inverse
from cellc.robot.planning.model import RobotModel, from_pose, to_pose
from cellc.robot.planning.problem import (
    Array,
    FailureReason,
    IkFailure,
    JointLimits,
    JointPath,
    LimitsError,
    PlanFailure,
    PlanningGroup,
)
from cellc.robot.planning.rrt_connect import connect, edge_is_free, shorten
from cellc.robot.planning.scene import CollisionScene

# Below this a finite tip speed asks for joint speeds hundreds of times larger: the arm has lost a direction.
MIN_SINGULAR_VALUE = 0.005
_SHORTCUT_ATTEMPTS = 20


class Planner:
    """Plans for one group; deterministic, and without memory from one call to the next."""

    def __init__(
        self, model: RobotModel, group: PlanningGroup, limits: JointLimits, scene: CollisionScene | None = None
    ) -> None:
        """Bind the planner.

        Args:
            limits: of the group's joints, in the same order.
            scene: what may collide; the model's own shapes where absent.

        Raises:
            LimitsError: the limits are not those of the group's joints.
            ModelError: a joint or link of the group does not exist.
        """
        if limits.joints != group.joints:
            raise LimitsError(f"the limits are for {limits.joints}, the group has {group.joints}")
        self.model = model
        self.group = group
        self.limits = limits
        self._bind(GroupChain(group, CollisionScene(model) if scene is None else scene))

    def _bind(self, chain: GroupChain) -> None:
        self.scene = chain.scene
        self._chain = chain
        self._base_in_world = to_pose(chain.transform_base_to_world)

    def in_scene(self, scene: CollisionScene) -> Planner:
        """Return the planner of the same group in another scene of the same model."""
        planner = copy.copy(self)
        planner._bind(self._chain.in_scene(scene))
        return planner

    def tip_pose(self, configuration: Sequence[float]) -> Pose:
        """Return the pose of the tip link in the frame of the group's base link."""
        tip = self._chain.tip(_array(configuration))
        return to_pose(self._chain.transform_base_to_world.actInv(tip))

    def min_singular_value(self, configuration: Sequence[float]) -> float:
        """Return the least singular value of the tip's Jacobian (rows in m and rad); 0 at a singularity."""
        return float(singular_values(self._chain, _array(configuration))[-1])

    def clearance_m(self, configuration: Sequence[float]) -> float | None:
        """Return the least distance from what the group moves to what is around, m; None where nothing is checked.

        Its own base and what may touch it do not stand around. Negative where shapes are in each other.
        """
        return self._chain.clearance_m(_array(configuration))

    def inverse_kinematics(
        self, target_in_base: Pose, current: Sequence[float], *, seeds: int = 8, rng_seed: int = 0
    ) -> IkSolution | IkFailure:
        """Find a configuration whose tip is at the target, the one nearest to ``current`` among those found.

        Args:
            target_in_base: wanted pose of the tip link in the frame of the group's base link.
            current: rad or meters; the first seed, and where distances are measured from.
            seeds: number of descents, of which all but the first start at configurations drawn with ``rng_seed``.
        """
        return solve_inverse(
            self._chain,
            self.limits,
            from_pose(self._base_in_world @ target_in_base),
            _array(current),
            seeds=seeds,
            rng_seed=rng_seed,
            min_singular_value=MIN_SINGULAR_VALUE,
        )

    def plan_to_configuration(
        self, start: Sequence[float], goal: Sequence[float], *, rng_seed: int = 0, max_iterations: int = 2000
    ) -> JointPath | PlanFailure:
        """Plan by the straight edge in joint space where it is free, else by RRT-Connect and shortcuts.

        Edges are checked so often that no point of the cell moves farther than 10 mm between two checks.
        """
        first, last = _array(start), _array(goal)
        failure = self._refuse_ends(first, last)
        if failure is not None:
            return failure
        if edge_is_free(self._chain, first, last):
            return self._path([first, last])
        path = connect(self._chain, self.limits, first, last, rng_seed=rng_seed, max_iterations=max_iterations)
        if path is None:
            return PlanFailure(FailureReason.NO_PATH, f"no path in {max_iterations} iterations of RRT-Connect")
        return self._path(shorten(self._chain, path, rng_seed=rng_seed, attempts=_SHORTCUT_ATTEMPTS))

    def plan_cartesian(self, start: Sequence[float], target_in_base: Pose) -> JointPath | PlanFailure:
        """Plan a straight line of the tip to the target, in steps of at most 5 mm and 0.05 rad.

        Args:
            start: rad or meters; the line begins where it puts the tip.
            target_in_base: wanted pose of the tip link in the frame of the group's base link.
        """
        first = _array(start)
        failure = self._refuse_start(first)
        if failure is not None:
            return failure
        target_in_world = self._base_in_world @ target_in_base
        return plan_line(self._chain, self.limits, first, target_in_world, min_singular_value=MIN_SINGULAR_VALUE)

    def _path(self, waypoints: list[Array]) -> JointPath:
        points = [tuple(point.tolist()) for point in waypoints]
        return JointPath(self.group.joints, tuple(pairwise(points)))

    def _refuse_start(self, start: Array) -> PlanFailure | None:
        outside = self.limits.violation(start)
        if outside:
            return PlanFailure(FailureReason.OUT_OF_LIMITS, f"start: {outside}")
        if self._chain.collides(start):
            return PlanFailure(FailureReason.START_IN_COLLISION, self._chain.describe_contact(start))
        return None

    def _refuse_ends(self, start: Array, goal: Array) -> PlanFailure | None:
        failure = self._refuse_start(start)
        if failure is not None:
            return failure
        outside = self.limits.violation(goal)
        if outside:
            return PlanFailure(FailureReason.OUT_OF_LIMITS, f"goal: {outside}")
        if self._chain.collides(goal):
            return PlanFailure(FailureReason.GOAL_IN_COLLISION, self._chain.describe_contact(goal))
        return None


def _array(configuration: Sequence[float]) -> Array:
    return np.array(configuration, dtype=np.float64)
