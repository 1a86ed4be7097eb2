"""Motion planning of one rehearsal: named poses and Cartesian goals in, timed trajectories or reasons out."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping

from cellc.mock.nodes.motion_model import MotionModel
from cellc.mock.nodes.motion_request import GoalPose, MotionRequest, PlannedMotion, SceneState, build_scene, plan_motion
from cellc.planning import Box, PlanFailure
from cellc.transforms import Pose

PLANNING_LATENCY_S = 0.05
"""Simulated time charged for every plan, whatever the host needs, so that a run is the same on every machine."""
OBJECT_EDGE_M = 0.02
"""Edge of the box that stands for a grasped object in collision checks: the contract states no size."""
_KEPT_PLANS = 256


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


class MotionPlanner:
    """Plans in a scene that follows what the gripper carries."""

    def __init__(self, memory: PlanMemory, rng_seed: int) -> None:
        """Bind the planner of one run; the same seed gives the same plans."""
        self._memory = memory
        self._model = memory.model
        self._scene = SceneState()
        self._rng_seed = rng_seed

    def plan(
        self, group: str, positions: Mapping[str, float], goal: tuple[float, ...] | GoalPose, retreat: Pose | None
    ) -> PlannedMotion | PlanFailure:
        """Plan to joint positions or to a pose of the tip.

        Args:
            positions: of all joints, rad or m.
            retreat: where the arm has to go back to on a straight line, because it stands at a goal.
        """
        joints = self._model.groups[group].planner.group.joints
        others = tuple((name, value) for name, value in self._independent(positions) if name not in joints)
        start = tuple(positions[joint] for joint in joints)
        return self._memory.plan(MotionRequest(group, start, others, self._scene, goal, retreat, self._rng_seed))

    def attach(self, name: str, link: str, pose_in_link: Pose, positions: Mapping[str, float]) -> None:
        """Let a grasped object move with a link; it may touch the gripper and what carries it now."""
        box = Box(name, link, (OBJECT_EDGE_M, OBJECT_EDGE_M, OBJECT_EDGE_M), pose_in_link)
        configuration = self._model.robot.configuration(dict(self._independent(positions)))
        touching = build_scene(self._model, self._scene, ()).touching(box, configuration)
        carrying = {child for child in self._model.links.joints if self._hangs_from(child, link)}
        may_touch = sorted({*touching, *carrying, link} & set(self._model.robot.links))
        allowed = (*self._scene.allowed, *((name, other) for other in may_touch))
        self._scene = SceneState((*self._scene.boxes, box), allowed)

    def detach(self, name: str) -> None:
        """Forget a released object."""
        boxes = tuple(box for box in self._scene.boxes if box.name != name)
        self._scene = SceneState(boxes, tuple(pair for pair in self._scene.allowed if name not in pair))

    def _independent(self, positions: Mapping[str, float]) -> list[tuple[str, float]]:
        return [(name, positions[name]) for name in sorted(positions) if name in self._model.robot.joints]

    def _hangs_from(self, link: str, ancestor: str) -> bool:
        return any(joint.parent == ancestor for joint in self._model.links.chain(link))
