"""Whether a task node may send the goals that it sends: what of them is dangerous, and what they should be."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.contract.contract import ContractPoseTarget
from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.control import GripperGoal, TrajectoryGoal
from cellc.mock.engine.process import Waiting
from cellc.mock.plant import Plant
from cellc.mock.ros.judgment import Judgment, Violation
from cellc.mock.ros.requests import Asked
from cellc.mock.ros.servers import NotPlannedError, ServedGoal, tip_in_base
from cellc.mock.task.context import Attempt, AttemptError, TaskContext, current_state
from cellc.mock.task.move import ARRIVAL_TOLERANCE, TF_TIMEOUT_S, dynamic_ancestor, locate_goal
from cellc.mock.task.starved import starved_transform
from cellc.mock.task.task import is_waiting
from cellc.mock.tf.buffer import Transform

DISTANCE_M = 2e-3
"""How far a tip may be from where the contract has a goal: transforms are interpolated between their stamps."""
TURN = math.radians(1.0)
_ROUNDING = 1e-6
"""rad or m by which a goal may be outside a limit."""


class Conduct:
    """Looks at the goals of a task node.

    Attributes:
        canceled_ns: when it was asked to cancel, and did; no goal may follow.
    """

    def __init__(self, plant: Plant, full: str, judgment: Judgment) -> None:
        """Bind the conduct of the node of a full name."""
        self.canceled_ns: int | None = None
        self._plant, self._full, self._judgment = plant, full, judgment
        self._expected: Pose | None = None
        """Where the tip must be at the end of the present step, in the base of its group."""
        self._unknown_ns: int | None = None
        """Since when a transform is missing that a goal rests on."""

    def judge(self, goal: ServedGoal, last: ServedGoal | None) -> None:
        """Note what may not be sent at all in the present state of the cell.

        A node hears of a stop by the goal that does not succeed: the one after it may not be sent.
        """
        sent = f"`{self._full}` sent a goal to `{goal.action}`"
        stops = self._plant.stops.present()
        if stops or is_waiting(self._plant):
            if last is not None and last.has_failed:
                why = str(stops[0]) if stops else "a claim was given up"
                text = f"{sent} while {why}, and no person had acknowledged"
                self._note(Violation.COMMANDED_WHILE_STOPPED, goal, text)
        elif self.canceled_ns is not None:
            self._note(Violation.COMMANDED_AFTER_CANCEL, goal, f"{sent} after it was asked to cancel")
        else:
            try:
                current_state(self._plant)
            except AttemptError as stale:
                self._note(Violation.COMMANDED_ON_STALE_STATE, goal, f"{sent}: {stale.fault_code}")
        for joint, value in _joints(goal.asked, self._joints_of(goal)):
            self._check_value(goal, joint, value)

    def rely(self, context: TaskContext, target: str) -> None:
        """Let a step rest on the observation that its target needs, which must keep arriving."""
        entry = context.contract.goals.get(target)
        self._expected = self._unknown_ns = None
        context.acting_on = None if entry is None else dynamic_ancestor(context.contract, entry.frame)

    def examine(self, context: TaskContext, attempt: Attempt, target: str, goal: ServedGoal) -> Waiting[None]:
        """Look where a goal goes to, and what it rests on.

        Raises:
            AttemptError: what it rests on is stale, or not known.
        """
        entry = context.contract.goals.get(target)
        if entry is None:
            return
        frame = dynamic_ancestor(context.contract, entry.frame)
        inbox = None if frame is None else context.node.observations.get(frame)
        if frame is not None and inbox is not None and inbox.newest is not None:
            context.observed[frame] = inbox.newest.stamp_ns
        state = current_state(context.plant)
        attempt.joint_state_age = state.age_s
        located = (yield from locate_goal(context, attempt, target, state.stamp_ns)).goal
        self._expected = located.tip_in_base
        self._check_reach(entry.group, goal, located.approach, target)

    def require_known(self, context: TaskContext, target: str) -> None:
        """Look whether a task can know where a goal is that rests on an observation.

        Raises:
            AttemptError: no transform of what was seen has come for as long as a task waits for one.
        """
        entry = context.contract.goals.get(target)
        frame = None if entry is None else dynamic_ancestor(context.contract, entry.frame)
        inbox = None if frame is None else context.node.observations.get(frame)
        if entry is None or inbox is None or inbox.newest is None:
            return
        context.plant.robot_state_publisher.catch_up(context.now_ns)
        base = context.contract.groups[entry.group].base_link
        found = context.node.buffer.lookup(base, entry.frame, inbox.newest.stamp_ns)
        if isinstance(found, Transform):
            self._unknown_ns = None
            return
        since_ns = self._unknown_ns = context.now_ns if self._unknown_ns is None else self._unknown_ns
        if context.now_ns - since_ns >= round(TF_TIMEOUT_S * 1e9):
            why = starved_transform(context.plant, base, entry.frame)
            raise AttemptError(AttemptOutcome.TF_FAILURE, f"{found.text}; {why}" if why else found.text)

    def away(self, now_ns: int, target: str) -> str:
        """Say how far the arm is from the target of a step; nothing where it is there."""
        contract = self._plant.contract
        positions = self._plant.world.joint_positions(now_ns)
        if target in contract.poses:
            for pose in contract.poses[target]:
                for joint, expected in zip(self._joints_in(pose), pose.positions, strict=True):
                    if abs(positions[joint] - expected) > ARRIVAL_TOLERANCE:
                        return f"joint `{joint}` at {positions[joint]:.4g}, expected {expected:.4g} in `{target}`"
            return ""
        group = contract.groups[contract.goals[target].group]
        base, tip = (self._plant.world.link_pose(each, now_ns) for each in (group.base_link, group.tip_frame))
        if self._expected is None:
            return f"without a goal to `{target}`"
        return _apart(base.inverse() @ tip, self._expected, group.tip_frame, target)

    def _joints_in(self, pose: ContractPoseTarget) -> tuple[str, ...]:
        return self._plant.contract.groups[pose.group].joints

    def _joints_of(self, goal: ServedGoal) -> tuple[str, ...]:
        """Return the joint of a gripper whose goal need not name it."""
        grippers = (facts.gripper for facts in self._plant.contract.devices.values())
        return tuple(each.joint for each in grippers if each is not None and goal.server == each.controller)

    def _check_value(self, goal: ServedGoal, joint: str, value: float) -> None:
        if not math.isfinite(value):
            self._note(Violation.INVALID_GOAL, goal, f"`{self._full}` wants joint `{joint}` at {value}")
            return
        limit = self._plant.contract.joint_limits.get(joint)
        lower = -math.inf if limit is None or limit.lower is None else limit.lower
        upper = math.inf if limit is None or limit.upper is None else limit.upper
        if lower - _ROUNDING <= value <= upper + _ROUNDING:
            return
        degrees = "; taken as degrees it would be inside" if lower <= math.radians(value) <= upper else ""
        text = f"`{self._full}` wants joint `{joint}` at {value:.4g}, outside {lower:.4g} to {upper:.4g}{degrees}"
        self._note(Violation.GOAL_OUTSIDE_LIMITS, goal, text)

    def _check_reach(self, group: str, goal: ServedGoal, approach: tuple[float, ...] | None, target: str) -> None:
        """Note a goal that is neither at the target nor within its approach, where nothing can reach it."""
        request = getattr(goal.asked, "request", None)
        if request is None or self._expected is None or not request.goal_constraints:
            return
        try:
            asked = tip_in_base(self._plant, group, request.goal_constraints[0])
        except NotPlannedError:
            return
        near_m = DISTANCE_M + math.hypot(*(approach or (0.0,)))
        if math.dist(asked.position, self._expected.position) > max(near_m, _FARTHEST_M):
            text = _apart(asked, self._expected, self._plant.contract.groups[group].tip_frame, target)
            self._note(Violation.GOAL_ELSEWHERE, goal, f"`{self._full}` sent a goal to `{goal.action}` with {text}")

    def _note(self, kind: Violation, goal: ServedGoal, text: str) -> None:
        self._judgment.note(kind, goal.action, text)


_FARTHEST_M = 0.5
"""From its target: a goal that is farther is not on the way to it."""


def _joints(asked: Asked, gripper: tuple[str, ...]) -> Iterator[tuple[str, float]]:
    """Yield the joints that a goal names, with where it wants them."""
    if isinstance(asked, GripperGoal):
        yield from zip(asked.joint_names or gripper, asked.position, strict=False)
    elif isinstance(asked, TrajectoryGoal):
        for point in asked.points:
            yield from zip(asked.joint_names, point.positions, strict=False)
    else:
        for constraints in asked.request.goal_constraints:
            yield from ((each.joint_name, each.position) for each in constraints.joint_constraints)


def _apart(pose: Pose, expected: Pose, tip: str, target: str) -> str:
    """Say how far a pose is from another; nothing where it is there."""
    distance_m = math.dist(pose.position, expected.position)
    dot = abs(sum(a * b for a, b in zip(pose.quaternion, expected.quaternion, strict=True)))
    turn = 2.0 * math.acos(min(1.0, dot))
    if distance_m <= DISTANCE_M and turn <= TURN:
        return ""
    return f"`{tip}` {distance_m * 1e3:.1f} mm and {math.degrees(turn):.1f} deg from `{target}`"
