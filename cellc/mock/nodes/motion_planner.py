"""The planner of the cell: trajectories of its groups in the present scene, kept by what was asked."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3
from cellc.mock.control.interfaces import Array
from cellc.mock.nodes.motion_model import GroupModel, MotionModel, PartModel
from cellc.robot.planning import (
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

_IK_ATTEMPTS = 4
"""Configurations tried before a goal: the straight approach is not possible from every one."""
_KEPT_SCENES = 4
PLANNING_LATENCY_S = 0.05
"""Simulated time charged for every plan, whatever the host needs, so that a run is the same on every machine."""
OBJECT_EDGE_M = 0.02
"""Edge of the box that represents a grasped object in collision checks: the contract states no size."""
_KEPT_PLANS = 256
_MEETING_NS = 20_000_000
"""Motions that begin together are looked at this often: at 1 m/s, every 20 mm."""


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
        others: positions of all other independent joints of its part, sorted by name.
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
    planner = group.planner.in_scene(build_scene(group.part, request.scene, request.others))
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


def build_scene(part: PartModel, state: SceneState, others: tuple[tuple[str, float], ...]) -> CollisionScene:
    """Return the scene of a request."""
    return _scene_of(part, state).with_other_positions(dict(others))


@lru_cache(maxsize=_KEPT_SCENES)
def _scene_of(part: PartModel, state: SceneState) -> CollisionScene:
    """Return the scene with all joints outside the group at rest; kept, since motions in a row share it."""
    if state == SceneState():
        return part.scene
    disabled = (*part.scene.disabled_collisions, *state.allowed)
    return CollisionScene(part.robot, disabled_collisions=disabled, boxes=state.boxes)


def _to_goal(
    group: GroupModel, planner: Planner, start: tuple[float, ...], goal: GoalPose, rng_seed: int
) -> JointPath | PlanFailure:
    """Try the configurations before the goal in turn; if all fail, report the failure of the first."""
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
    """Return the pose of the tip before the approach; the goal itself without one."""
    if goal.approach is None:
        return goal.tip_in_base
    return goal.tip_in_base @ Pose(goal.approach, (0.0, 0.0, 0.0, 1.0))


def _link_pose(group: GroupModel, tip_in_base: Pose) -> Pose:
    return tip_in_base @ group.transform_tip_to_link.inverse()


class PlanMemory:
    """Answers of the planner by their question, the last used ones: rehearsals of a cell ask the same again."""

    def __init__(self, model: MotionModel) -> None:
        self.model = model
        self._answers: OrderedDict[MotionRequest, PlannedMotion | PlanFailure] = OrderedDict()

    def plan(self, request: MotionRequest) -> PlannedMotion | PlanFailure:
        """Return what ``plan_motion`` returns, the same value whether it was asked before or not."""
        answer = self._answers.pop(request, None)
        if answer is None:
            answer = plan_motion(self.model, request)
        self._answers[request] = answer
        if len(self._answers) > _KEPT_PLANS:
            self._answers.popitem(last=False)
        return answer


def _tracks(motion: TimedTrajectory) -> Iterator[tuple[str, Array, Array]]:
    """Yield each joint of a trajectory with the times of its points, ns, and its positions there, rad or m."""
    times = np.array([point.time_from_start_ns for point in motion.points], dtype=np.float64)
    positions = np.array([point.positions for point in motion.points], dtype=np.float64)
    yield from ((joint, times, positions[:, index]) for index, joint in enumerate(motion.joints))


class MotionPlanner:
    """Plans in a scene that follows what the gripper carries."""

    def __init__(self, memory: PlanMemory, rng_seed: int) -> None:
        """Bind the planner of one run; the same seed gives the same plans."""
        self._memory = memory
        self._model = memory.model
        self._scenes = dict.fromkeys(self._model.parts, SceneState())
        self._rng_seed = rng_seed

    @property
    def links(self) -> Collection[str]:
        """Names of the links that hang from another one."""
        return self._model.links.joints.keys()

    def plan(
        self, group: str, positions: Mapping[str, float], goal: tuple[float, ...] | GoalPose, retreat: Pose | None
    ) -> PlannedMotion | PlanFailure:
        """Plan to joint positions or to a pose of the tip.

        Args:
            positions: of all joints, rad or m.
            retreat: where the arm has to go back to on a straight line, because it is at a goal.
        """
        model = self._model.groups[group]
        joints, scene = model.planner.group.joints, self._scenes[model.part]
        others = tuple((name, value) for name, value in model.part.own(positions).items() if name not in joints)
        start = model.planner.limits.inside([positions[joint] for joint in joints], model.start_outside)
        return self._memory.plan(MotionRequest(group, start, others, scene, goal, retreat, self._rng_seed))

    def room(self, group: str, positions: Mapping[str, float]) -> tuple[float, float | None]:
        """Return the least singular value of the tip's Jacobian where a group is, and its clearance in m.

        Six decimals of the value: the last bits of a decomposition are others with another numpy.

        Args:
            positions: of all joints, rad or m.
        """
        model = self._model.groups[group]
        others = tuple(model.part.own(positions).items())
        planner = model.planner.in_scene(build_scene(model.part, self._scenes[model.part], others))
        stands = tuple(positions[joint] for joint in planner.group.joints)
        return round(planner.min_singular_value(stands), 6), planner.clearance_m(stands)

    def meeting(self, motions: Sequence[TimedTrajectory], positions: Mapping[str, float]) -> PlanFailure | None:
        """Tell when motions that begin together would touch on their way; None where they keep clear of each other.

        Args:
            positions: of all joints before they begin, rad or m.
        """
        tracks = [track for motion in motions for track in _tracks(motion)]
        parts = dict.fromkeys(self._model.part_of(joint) for joint, _, _ in tracks)
        scenes = [(part, build_scene(part, self._scenes[part], ()), part.own(positions)) for part in parts]
        for at_ns in range(0, max(motion.duration_ns for motion in motions) + _MEETING_NS, _MEETING_NS):
            # On straight lines between the points, then at rest.
            moved = {joint: float(np.interp(at_ns, times, values)) for joint, times, values in tracks}
            if any(scene.collides(part.robot.configuration(rest | part.own(moved))) for part, scene, rest in scenes):
                return PlanFailure(
                    FailureReason.NO_PATH, f"groups that move together touch {at_ns / 1e9:g} s on their way"
                )
        return None

    def attach(self, name: str, link: str, pose_in_link: Pose, positions: Mapping[str, float]) -> None:
        """Let a grasped object move with a link; it may touch the gripper and what carries it now."""
        box = Box(name, link, (OBJECT_EDGE_M, OBJECT_EDGE_M, OBJECT_EDGE_M), pose_in_link)
        carrying = {child for child in self._model.links.joints if self._hangs_from(child, link)}
        for part, state in self._scenes.items():
            if link not in part.robot.links:
                continue
            configuration = part.robot.configuration(part.own(positions))
            touching = build_scene(part, state, ()).touching(box, configuration)
            may_touch = sorted({*touching, *carrying, link} & set(part.robot.links))
            allowed = (*state.allowed, *((name, other) for other in may_touch))
            self._scenes[part] = SceneState((*state.boxes, box), allowed)

    def detach(self, name: str) -> None:
        """Forget a released object."""
        for part, state in self._scenes.items():
            boxes = tuple(box for box in state.boxes if box.name != name)
            self._scenes[part] = SceneState(boxes, tuple(pair for pair in state.allowed if name not in pair))

    def _hangs_from(self, link: str, ancestor: str) -> bool:
        return any(joint.parent == ancestor for joint in self._model.links.chain(link))
