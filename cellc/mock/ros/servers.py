"""The actions of the cell that is played, with goals of clients on the graph.

A goal of a controller is sent to it unchanged. A goal of the planner is planned, then sent to the controller of its
group, as move_group does; codes are those of moveit_msgs/MoveItErrorCodes.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from time import monotonic, sleep

from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.bus.qos import served_actions
from cellc.mock.control import ControlEvent, GoalStatus, GripperEnded, GripperGoal, TrajectoryEnded, TrajectoryGoal
from cellc.mock.control.messages import TrajectoryFeedback
from cellc.mock.engine.process import Signal
from cellc.mock.nodes.motion_planner import PLANNING_LATENCY_S, GoalPose, PlannedMotion
from cellc.mock.plant import Plant
from cellc.mock.ros.bridge import Bridge, Received
from cellc.mock.ros.fingers import Fingers
from cellc.mock.ros.graph import Graph
from cellc.mock.ros.incoming import MalformedMessageError
from cellc.mock.ros.requests import (
    FOLLOW_JOINT_TRAJECTORY,
    GRIPPER_COMMAND,
    MOVE_GROUP,
    PARALLEL_GRIPPER_COMMAND,
    Asked,
    Constraints,
    MoveRequest,
    asked_of,
    feedback_of,
    planned,
    result_of,
)
from cellc.mock.task.context import AttemptError, current_state
from cellc.mock.task.execute import SentGoal, joints_of
from cellc.mock.task.move import trajectory_goal
from cellc.mock.task_status import ForeignGoal
from cellc.mock.tf.buffer import Transform
from cellc.robot.planning import PlanFailure, TimedTrajectory
from cellc.robot.planning import TrajectoryPoint as PlannedPoint

SERVED = (MOVE_GROUP, FOLLOW_JOINT_TRAJECTORY, GRIPPER_COMMAND, PARALLEL_GRIPPER_COMMAND)
_SUCCESS, _PLANNING_FAILED, _CONTROL_FAILED, _PREEMPTED = 1, -1, -4, -7
_INVALID_GROUP, _INVALID_GOAL, _INVALID_LINK, _NO_TRANSFORM = -15, -16, -18, -21
_LOOK_S = 0.02
_CLIENT = "a client on the graph"
_ACCEPTED = 0
"""Of action_msgs/srv/CancelGoal."""


@dataclass(slots=True)
class ServedGoal:
    """A goal of a client on the graph, from its arrival to its end.

    Attributes:
        end: number of its end.
        server: node that takes it.
        accepted: whether it was; None without an answer.
        sent: what a controller executes of it.
        trajectory: that was planned for it.
        cancel_ns: when the client asked to cancel it.
        status: state of action_msgs/msg/GoalStatus that it ended in.
        failure: why it did not succeed, with the outcome that this is.
    """

    action: str
    kind: str
    end: int
    server: str
    arrived_ns: int
    asked: Asked
    controller: str = ""
    accepted: bool | None = None
    sent: SentGoal | None = None
    trajectory: TimedTrajectory | None = None
    cancel_ns: int | None = None
    ended_ns: int | None = None
    status: GoalStatus | None = None
    failure: AttemptError | None = None

    @property
    def is_grip(self) -> bool:
        """Tell whether it is one of a gripper."""
        return isinstance(self.asked, GripperGoal)

    @property
    def is_open(self) -> bool:
        """Tell whether it was accepted and has not ended."""
        return bool(self.accepted) and self.ended_ns is None

    @property
    def has_failed(self) -> bool:
        """Tell whether its client knows that it did not succeed."""
        return self.accepted is False or (self.ended_ns is not None and self.status is not GoalStatus.SUCCEEDED)


Judge = Callable[[ServedGoal, "ServedGoal | None"], None]
"""Looks at a goal and the one before it."""


class ActionServers:
    """Takes goals, and lets the cell that is played execute them.

    Attributes:
        goals: in the order of their arrival.
        changed: fires when a goal begins, is canceled or ends.
    """

    def __init__(self, plant: Plant, graph: Graph, bridge: Bridge, judge: Judge | None = None) -> None:
        """Bind the servers of the contract's actions; nothing is offered yet.

        Args:
            judge: called with each goal as it arrives, before it is answered, and the goal before it; None where the
                task is played, and each goal is one of another client.
        """
        self._judge = judge
        self.goals: list[ServedGoal] = []
        self.changed = Signal()
        self.fingers = Fingers(plant)
        self._plant, self._graph, self._bridge = plant, graph, bridge
        self._controller_of = {action: name for name, action in served_actions(plant.contract).items() if action}
        self._channels: dict[int, tuple[str, str]] = {}
        self._actions = [
            (name, interface)
            for name, interface in plant.contract.interfaces.items()
            if interface.kind == "action" and interface.sources and interface.type in SERVED
        ]
        plant.control.listen(self._hear)

    def offer(self) -> None:
        """Offer the actions, as their servers do when they are active."""
        for name, interface in self._actions:
            source = interface.sources[0]
            self._channels[self._graph.act(source.full_name, name, interface.type)] = name, source.node

    def await_client(self, node: str, full: str, within_s: float) -> None:
        """Let the host's time pass until a node has found its actions: time of the run would pass without its goals."""
        until_s = monotonic() + within_s
        for name in (name for name, each in self._actions if any(sink.node == node for sink in each.sinks)):
            topic = f"{name}/_action/status"
            while all(end.node != full for end in self._bridge.subscriptions(topic)) and monotonic() < until_s:
                sleep(_LOOK_S)

    def open_goals(self) -> tuple[ServedGoal, ...]:
        """Return the goals that execute."""
        return tuple(goal for goal in self.goals if goal.is_open)

    def take(self, received: Received) -> bool:
        """Take a request, where it is one of these actions, at the present instant of the run.

        Raises:
            MalformedMessageError: it cannot be read.
        """
        if received.channel not in self._channels:
            return False
        name, server = self._channels[received.channel]
        said = json.loads(received.data)
        number = said["number"]
        now_ns, simulation = self._plant.now_ns, self._plant.simulation
        if "cancel" in said:
            simulation.at(now_ns, partial(self._cancel, number, said["cancel"]))
            return True
        kind = self._plant.contract.interfaces[name].type
        try:
            asked = asked_of(kind, said["goal"])
        except MalformedMessageError:
            self._bridge.answer(number, value=False)
            raise
        controller = "" if isinstance(asked, MoveRequest) else self._controller_of[name]
        goal = ServedGoal(name, kind, said["end"], server, now_ns, asked, controller)
        simulation.at(now_ns, partial(self._begin, number, goal))
        return True

    # -- goals -------------------------------------------------------------------------------------------------------

    def _begin(self, number: int, goal: ServedGoal) -> None:
        """Answer a goal, unless its server answers no client."""
        last = self.goals[-1] if self.goals else None
        self.goals.append(goal)
        if self._judge is not None:
            self._judge(goal, last)
        if self._plant.network.answers(goal.server):
            if isinstance(goal.asked, MoveRequest):
                goal.accepted = True
                self._bridge.answer(number, value=True)
                self._bridge.feed_back(goal.end, goal.kind, {"state": "PLANNING"})
                due_ns = self._plant.now_ns + round(PLANNING_LATENCY_S * 1e9)
                self._plant.simulation.at(due_ns, partial(self._plan, goal, goal.asked))
            else:
                self._send(goal, goal.asked)
                self._bridge.answer(number, value=bool(goal.accepted))
        self.changed.fire(self._plant.now_ns)

    def _send(self, goal: ServedGoal, asked: TrajectoryGoal | GripperGoal) -> str:
        """Send a goal to its controller; return why it was rejected, or nothing."""
        control, actions = self._plant.control, self._plant.task.actions
        if isinstance(asked, GripperGoal):
            self.fingers.begin(goal.controller, asked)
        response = control.send_goal(goal.controller, asked, feedback=goal.kind == FOLLOW_JOINT_TRAJECTORY)
        goal.accepted = goal.accepted or response.accepted
        if not response.accepted:
            goal.failure = AttemptError(AttemptOutcome.GOAL_REJECTION, response.log_reason)
            return response.log_reason
        joints = joints_of(self._plant, goal.controller)
        goal.sent = SentGoal(goal.controller, response.goal_id, joints, self._plant.now_ns)
        if self._judge is None:
            actions.note_foreign(ForeignGoal(goal.controller, response.goal_id, _CLIENT), self._plant.now_ns)
        else:
            actions.note_started(goal.controller)
        return ""

    def _cancel(self, number: int, end: int) -> None:
        goal = next((each for each in self.goals if each.end == end), None)
        if goal is None:
            return
        now_ns = self._plant.now_ns
        goal.cancel_ns = now_ns if goal.cancel_ns is None else goal.cancel_ns
        if not self._plant.network.answers(goal.server):
            return
        accepted = goal.is_open
        if goal.sent is not None and accepted and self._plant.network.answers(goal.controller):
            manager = self._plant.control.server_of(goal.controller)
            accepted = manager.cancel_goal(goal.sent.goal_id).return_code == _ACCEPTED
        self._bridge.answer(number, value=accepted or isinstance(goal.asked, MoveRequest))
        if goal.is_open and goal.sent is None:
            self._end_move(goal, GoalStatus.CANCELED, _PREEMPTED)
        self.changed.fire(now_ns)

    def _hear(self, event: ControlEvent) -> None:
        """Tell a client of the end of its goal, or how far it has come."""
        if not isinstance(event, (TrajectoryEnded, GripperEnded, TrajectoryFeedback)):
            return
        goal = next((each for each in self.open_goals() if _is_of(event, each)), None)
        if goal is None or not self._plant.network.answers(event.controller):
            return
        if isinstance(event, TrajectoryFeedback):
            if goal.kind == FOLLOW_JOINT_TRAJECTORY and goal.sent is not None:
                self._bridge.feed_back(goal.end, goal.kind, feedback_of(event, goal.sent.joints))
            return
        if isinstance(event, GripperEnded):
            self.fingers.end(event.controller, event)
        if isinstance(goal.asked, MoveRequest):
            succeeded, canceled = event.status is GoalStatus.SUCCEEDED, goal.cancel_ns is not None
            code = _SUCCESS if succeeded else (_PREEMPTED if canceled else _CONTROL_FAILED)
            self._end_move(goal, event.status if succeeded or canceled else GoalStatus.ABORTED, code)
        else:
            self._end(goal, event.status, result_of(goal.kind, event))

    def _end_move(self, goal: ServedGoal, status: GoalStatus, code: int, why: str = "") -> None:
        """End a goal of the planner."""
        trajectory = {} if goal.trajectory is None else {"planned_trajectory": planned(goal.trajectory)}
        result = {"error_code": {"val": code, "message": why}, "planning_time": PLANNING_LATENCY_S, **trajectory}
        self._end(goal, status, result)

    def _end(self, goal: ServedGoal, status: GoalStatus, result: Mapping[str, object]) -> None:
        now_ns = self._plant.now_ns
        goal.ended_ns, goal.status = now_ns, status
        if goal.sent is not None and self._judge is not None:
            self._plant.task.actions.note_ended(goal.controller)
        self._bridge.end_goal(goal.end, int(status), result)
        self.changed.fire(now_ns)

    # -- planner -----------------------------------------------------------------------------------------------------

    def _plan(self, goal: ServedGoal, asked: MoveRequest) -> None:
        """Plan what was asked for, and let the controller of the group execute it."""
        if not goal.is_open:
            return
        try:
            motion = self._planned(asked)
        except NotPlannedError as error:
            goal.failure = AttemptError(error.outcome, error.why)
            self._end_move(goal, GoalStatus.ABORTED, error.code, error.why)
            return
        goal.trajectory = motion.trajectory
        if asked.planning_options.plan_only:
            self._end_move(goal, GoalStatus.SUCCEEDED, _SUCCESS)
            return
        goal.controller = self._plant.contract.groups[asked.request.group_name].controller or ""
        self._bridge.feed_back(goal.end, goal.kind, {"state": "MONITOR"})
        rejected = self._send(goal, trajectory_goal(_slowed(motion, asked.request.max_velocity_scaling_factor)))
        if rejected:
            self._end_move(goal, GoalStatus.ABORTED, _CONTROL_FAILED, rejected)

    def _planned(self, asked: MoveRequest) -> PlannedMotion:
        plant, request = self._plant, asked.request
        group = plant.contract.groups.get(request.group_name)
        if group is None or group.controller is None:
            raise NotPlannedError(_INVALID_GROUP, f"no group `{request.group_name}`")
        if len(request.goal_constraints) != 1:
            raise NotPlannedError(_INVALID_GOAL, f"{len(request.goal_constraints)} sets of goal constraints")
        try:
            positions = current_state(plant).positions
        except AttemptError as stale:
            raise NotPlannedError(_PLANNING_FAILED, stale.fault_code, stale.outcome) from None
        goal = _goal(plant, request.group_name, request.goal_constraints[0])
        answer = plant.planner.plan(request.group_name, positions, goal, None)
        if isinstance(answer, PlanFailure):
            raise NotPlannedError(_PLANNING_FAILED, f"{answer.reason.value}: {answer.detail}")
        return answer


class NotPlannedError(CellcError):
    """Says why there is no plan, with its code, and how the attempt ends."""

    def __init__(self, code: int, why: str, outcome: AttemptOutcome = AttemptOutcome.PLANNING_FAILURE) -> None:
        super().__init__(why)
        self.code, self.why, self.outcome = code, why, outcome


def _is_of(event: TrajectoryEnded | GripperEnded | TrajectoryFeedback, goal: ServedGoal) -> bool:
    return goal.sent is not None and goal.sent.key == (event.controller, event.goal_id)


def _goal(plant: Plant, name: str, constraints: Constraints) -> tuple[float, ...] | GoalPose:
    """Return what constraints ask of a group: positions of its joints, or where its tip is to be in its base."""
    group = plant.contract.groups[name]
    if constraints.joint_constraints:
        positions = {each.joint_name: each.position for each in constraints.joint_constraints}
        if set(positions) != set(group.joints):
            text = f"joint constraints must name the joints of `{name}`, got {', '.join(sorted(positions))}"
            raise NotPlannedError(_INVALID_GOAL, text)
        return tuple(positions[joint] for joint in group.joints)
    stated = constraints.link_pose()
    if stated is None:
        raise NotPlannedError(_INVALID_GOAL, "constraints must be joints, or one position and one orientation")
    link, _, _ = stated
    if link != group.tip_frame:
        raise NotPlannedError(_INVALID_LINK, f"constraints are on `{link}`, the tip of `{name}` is `{group.tip_frame}`")
    return GoalPose(tip_in_base(plant, name, constraints), None)


def tip_in_base(plant: Plant, name: str, constraints: Constraints) -> Pose:
    """Return where constraints want the tip of a group, in its base, by the latest transforms, as move_group has it.

    Raises:
        NotPlannedError: nothing connects their frame to the base.
    """
    stated = constraints.link_pose()
    if stated is None:
        raise NotPlannedError(_INVALID_GOAL, "no pose")
    _, frame, pose = stated
    plant.robot_state_publisher.catch_up(plant.now_ns)
    found = plant.task.buffer.lookup(plant.contract.groups[name].base_link, frame, 0)
    if not isinstance(found, Transform):
        raise NotPlannedError(_NO_TRANSFORM, found.text)
    return found.pose @ pose


def _slowed(motion: PlannedMotion, factor: float) -> TimedTrajectory:
    """Return a motion at a share of its velocity; 0 and what is above 1 mean all of it, as in MoveIt."""
    share = factor if 0.0 < factor <= 1.0 else 1.0
    return replace(motion.trajectory, points=tuple(_slowed_points(motion.trajectory, share)))


def _slowed_points(trajectory: TimedTrajectory, share: float) -> Iterator[PlannedPoint]:
    for point in trajectory.points:
        yield replace(
            point,
            velocities=tuple(share * value for value in point.velocities),
            accelerations=tuple(share * share * value for value in point.accelerations),
            time_from_start_ns=round(point.time_from_start_ns / share),
        )
