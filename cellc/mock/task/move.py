"""A move step: locate the goal, plan, execute, and check that the joints arrived."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from cellc.contract.attempt import PacketStep
from cellc.contract.contract import Contract, ContractGoal, ContractPoseTarget
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.control import GripperGoal, TrajectoryGoal, TrajectoryPoint
from cellc.mock.engine.process import Waiting
from cellc.mock.nodes.motion_planner import PLANNING_LATENCY_S, GoalPose, PlannedMotion
from cellc.mock.plant import Plant
from cellc.mock.reality import Arrival
from cellc.mock.task.bounds import goal_timeout_s, planning_server
from cellc.mock.task.context import Attempt, AttemptError, CurrentState, TaskContext, current_state
from cellc.mock.task.execute import await_response, execute_together, require_success
from cellc.mock.task.starved import starved_transform
from cellc.mock.task_status import PlanBegan
from cellc.mock.tf.buffer import Transform
from cellc.robot.planning import PlanFailure, TimedTrajectory

TF_TIMEOUT_S = 0.2
"""How long a lookup waits for transforms that are on their way: four intervals of robot_state_publisher."""

_LOOK_NS = 10_000_000
ARRIVAL_TOLERANCE = 0.05
"""rad or m by which a joint may miss the end of a trajectory that its controller calls a success."""
MARGIN_S = 10.0
"""Beyond twice the planned duration: the bound of an execution where no action of the contract states one."""


@dataclass(frozen=True, slots=True)
class LocatedGoal:
    """A goal in the group's base, and the dynamic frame whose observation it rests on."""

    goal: GoalPose
    observed_frame: str | None


def locate_goal(context: TaskContext, attempt: Attempt, name: str, state_stamp_ns: int) -> Waiting[LocatedGoal]:
    """Look the goal's frame up and express the goal in the base of its group.

    Args:
        state_stamp_ns: stamp of the joint state, for goals that rest on no observation.

    Raises:
        AttemptError: stale_state or tf_failure.
    """
    contract = context.contract
    entry = contract.goals[name]
    base = contract.groups[entry.group].base_link
    observed_frame = dynamic_ancestor(contract, entry.frame)
    stamp_ns = _stamp(context, entry, base, observed_frame, state_stamp_ns)
    attempt.goal_frame, attempt.goal_stamp = entry.frame, stamp_ns
    attempt.calibration_id = _calibrations(context, base, entry)
    if observed_frame is not None:
        attempt.mark(PacketStep.OBSERVED, stamp_ns)
    transform = yield from _lookup(context, base, entry.frame, stamp_ns)
    attempt.tf_lookup_age = context.plant.clocks.age_ns(context.node.name, stamp_ns) / 1e9
    attempt.mark(PacketStep.TRANSFORMED, context.now_ns)
    displaced = Pose(context.node.requests.displacement(name), (0.0, 0.0, 0.0, 1.0)) @ Pose(
        entry.pose.xyz, entry.pose.quaternion
    )
    return LocatedGoal(GoalPose(transform.pose @ displaced, entry.approach), observed_frame)


def dynamic_ancestor(contract: Contract, frame: str) -> str | None:
    """Return the dynamic frame that a frame is, or hangs from; None where no observation is involved."""
    for _ in range(len(contract.frames) + 1):
        entry = contract.frames.get(frame)
        if entry is None:
            return None
        if entry.kind == "dynamic":
            return frame
        frame = entry.parent
    return None


def _stamp(
    context: TaskContext, entry: ContractGoal, base: str, observed_frame: str | None, state_stamp_ns: int
) -> int:
    if entry.transform_at == "latest":
        latest = context.node.buffer.latest_ns(base, entry.frame)
        return state_stamp_ns if latest is None else latest
    if observed_frame is None:
        latest = context.node.buffer.latest_ns(base, entry.frame)
        return state_stamp_ns if latest is None else min(latest, state_stamp_ns)
    if observed_frame not in context.observed:
        raise AttemptError(AttemptOutcome.STALE_STATE, f"frame {observed_frame} was never observed")
    stamp_ns = context.observed[observed_frame]
    check_observation(context, observed_frame, stamp_ns)
    return stamp_ns


def check_observation(context: TaskContext, frame: str, stamp_ns: int, allowance_s: float = 0.0) -> None:
    """Raise AttemptError where an observation is too old to act on.

    Args:
        allowance_s: time that planning has taken since the observation was checked first.
    """
    inbox = context.node.observations.get(frame)
    if inbox is not None and inbox.is_stale(stamp_ns, allowance_s):
        raise context.stale(frame, inbox.describe_age(frame, stamp_ns))


def _lookup(context: TaskContext, target: str, source: str, stamp_ns: int) -> Waiting[Transform]:
    """Look a transform up; a stamp that is ahead of the buffer is waited for, within a bound."""
    until_ns = context.now_ns + round(TF_TIMEOUT_S * 1e9)
    while True:
        context.plant.robot_state_publisher.catch_up(context.now_ns)
        context.check_authorities(context.node.buffer.path(target, source))
        answer = context.node.buffer.lookup(target, source, stamp_ns)
        if isinstance(answer, Transform):
            return answer
        if not answer.kind.may_pass or context.now_ns >= until_ns:
            current_state(context.plant)  # joint states that stay away are the cause, transforms only follow them
            why = starved_transform(context.plant, target, source)
            raise AttemptError(AttemptOutcome.TF_FAILURE, f"{answer.text}; {why}" if why else answer.text)
        yield from context.pause(min(until_ns, context.now_ns + 5_000_000))


def _calibrations(context: TaskContext, base: str, entry: ContractGoal) -> tuple[str, ...]:
    """Return the calibrations, with revision, of every edge between base and goal, and between base and tip."""
    contract = context.contract
    edges = {
        *context.node.buffer.path(base, entry.frame),
        *context.node.buffer.path(base, contract.groups[entry.group].tip_frame),
    }
    ids = {contract.frames[edge].calibration for edge in edges if edge in contract.frames}
    return tuple(
        f"{name}:{contract.calibrations[name].revision}"
        for name in sorted(name for name in ids if name is not None)
        if name in contract.calibrations
    )


def state_since(context: TaskContext, instant_ns: int) -> Waiting[CurrentState]:
    """Wait for a joint state that is not older than an instant, as long as the newest one is not stale."""
    while (state := current_state(context.plant)).taken_ns < instant_ns:
        yield from context.pause(context.now_ns + _LOOK_NS)
    return state


def move(context: TaskContext, attempt: Attempt, target: str, *, together: bool = False) -> Waiting[None]:
    """Move to a named pose, group after group or all together, or to a goal.

    Raises:
        AttemptError: it does not get there.
    """
    contract = context.contract
    if target in contract.poses and together:
        yield from _move_together(context, attempt, contract.poses[target])
    elif target in contract.poses:
        for pose in contract.poses[target]:
            yield from _move_to_pose(context, attempt, pose)
    elif target in contract.goals:
        yield from _move_to_goal(context, attempt, target)
    else:
        raise AttemptError(AttemptOutcome.PLANNING_FAILURE, f"neither a pose nor a goal is named {target}")


def _move_to_pose(context: TaskContext, attempt: Attempt, pose: ContractPoseTarget) -> Waiting[None]:
    state = current_state(context.plant)
    attempt.joint_state_age = state.age_s
    retreat = context.retreats.get(pose.group)
    planned = context.plant.planner.plan(pose.group, state.positions, pose.positions, retreat)
    motion = yield from _planning_time(context, attempt, planned)
    yield from _drive(context, attempt, {pose.group: motion}, None)


def _move_together(context: TaskContext, attempt: Attempt, poses: Sequence[ContractPoseTarget]) -> Waiting[None]:
    """Plan each group alone, hold the motions against each other, and let them begin at one instant."""
    state = current_state(context.plant)
    attempt.joint_state_age = state.age_s
    planner, motions = context.plant.planner, dict[str, PlannedMotion]()
    for pose in poses:
        planned = planner.plan(pose.group, state.positions, pose.positions, context.retreats.get(pose.group))
        if isinstance(planned, PlanFailure):
            yield from _planning_time(context, attempt, planned)
        else:
            motions[pose.group] = planned
    first = next(iter(motions.values()))
    meeting = planner.meeting([motion.trajectory for motion in motions.values()], state.positions)
    yield from _planning_time(context, attempt, first if meeting is None else meeting)
    yield from _drive(context, attempt, motions, None)


def _move_to_goal(context: TaskContext, attempt: Attempt, name: str) -> Waiting[None]:
    group = context.contract.goals[name].group
    before = current_state(context.plant)
    located = yield from locate_goal(context, attempt, name, before.stamp_ns)
    state = current_state(context.plant)
    attempt.joint_state_age = state.age_s
    retreat = context.retreats.get(group)
    planned = context.plant.planner.plan(group, state.positions, located.goal, retreat)
    motion = yield from _planning_time(context, attempt, planned)
    if located.observed_frame is not None:
        stamp_ns = context.observed[located.observed_frame]
        check_observation(context, located.observed_frame, stamp_ns, allowance_s=PLANNING_LATENCY_S)
    yield from _drive(context, attempt, {group: motion}, located.observed_frame)
    note_arrival(context, name, attempt.tf_lookup_age)


def note_arrival(context: TaskContext, name: str, transform_age_s: float | None) -> None:
    """Note how far the tip really is from where the goal really is, which no node of the cell knows."""
    plant, goal = context.plant, context.contract.goals[name]
    place = _really(plant, goal.frame)
    tip = _really(plant, context.contract.groups[goal.group].tip_frame)
    if place is not None and tip is not None:
        positions = plant.world.joint_positions(plant.now_ns)
        singular_value, clearance_m = plant.planner.room(goal.group, positions)
        plant.arrivals.append(
            Arrival(
                name,
                plant.now_ns,
                math.dist(tip.position, place.apply(goal.pose.xyz)),
                singular_value,
                _joint_room(context.contract, goal.group, positions),
                clearance_m,
                transform_age_s,
            )
        )


def _joint_room(contract: Contract, group: str, positions: Mapping[str, float]) -> float | None:
    """Return how near the joints of a group are to an end: the least share of its range that one has left."""
    shares = []
    for joint in contract.groups[group].joints:
        limit = contract.joint_limits.get(joint)
        if limit is not None and limit.lower is not None and limit.upper is not None and joint in positions:
            left = min(positions[joint] - limit.lower, limit.upper - positions[joint])
            shares.append(left / (limit.upper - limit.lower))
    return min(shares, default=None)


def _really(plant: Plant, frame: str) -> Pose | None:
    """Return where a frame really is in the root; None where nothing in the world represents it."""
    if frame in plant.world.objects():
        return plant.world.object_pose(frame, plant.now_ns)
    entry = plant.contract.frames.get(frame)
    if frame in plant.planner.links or entry is None:
        return plant.world.link_pose(frame, plant.now_ns)
    above = None if entry.pose is None else _really(plant, entry.parent)
    return None if above is None or entry.pose is None else above @ entry.pose.pose


def _planning_time(
    context: TaskContext, attempt: Attempt, planned: PlannedMotion | PlanFailure
) -> Waiting[PlannedMotion]:
    """Let the simulated time of planning pass, then answer."""
    yield from await_response(context, planning_server(context.contract))
    context.node.actions.tell(PlanBegan(attempt.attempt_id, context.now_ns))
    until_ns = context.now_ns + round(PLANNING_LATENCY_S * 1e9)
    while context.now_ns < until_ns:
        yield from context.pause(until_ns)
    attempt.mark(PacketStep.PLANNED, context.now_ns)
    if isinstance(planned, PlanFailure):
        attempt.plan_result = f"{planned.reason.value}: {planned.detail}"
        raise AttemptError(AttemptOutcome.PLANNING_FAILURE, attempt.plan_result)
    attempt.plan_result = "success"
    return planned


def _drive(
    context: TaskContext, attempt: Attempt, motions: Mapping[str, PlannedMotion], observed_frame: str | None
) -> Waiting[None]:
    """Check the state once more and execute; each arm is at a goal afterwards, or no longer at one."""
    current_state(context.plant)
    goals: dict[str, TrajectoryGoal | GripperGoal] = {}
    timeout_s = 0.0
    for group, motion in motions.items():
        controller = context.contract.groups[group].controller
        if controller is None:
            raise AttemptError(AttemptOutcome.GOAL_REJECTION, f"no controller moves group {group}")
        context.retreats.pop(group, None)
        goals[controller] = trajectory_goal(motion.trajectory)
        timeout_s = max(timeout_s, move_timeout_s(context, controller, motion.trajectory.duration_ns * 1e-9))
    context.acting_on = observed_frame
    for ended in (yield from execute_together(context, attempt, "move", goals, timeout_s)):
        require_success(ended, context)
        state = yield from state_since(context, ended.decided_ns)
    for group, motion in motions.items():
        _require_arrival(state, motion.trajectory)
        if motion.retreat is not None:
            context.retreats[group] = motion.retreat


def _require_arrival(state: CurrentState, trajectory: TimedTrajectory) -> None:
    """Raise AttemptError where a joint is elsewhere: a controller without tolerances reports success all the same."""
    actual = state.positions
    for joint, goal in zip(trajectory.joints, trajectory.points[-1].positions, strict=True):
        if abs(actual[joint] - goal) > ARRIVAL_TOLERANCE:
            text = f"joint {joint} is at {actual[joint]:.4g} after a reported success, but its goal is {goal:.4g}"
            raise AttemptError(AttemptOutcome.TOLERANCE_VIOLATION, text)


def trajectory_goal(trajectory: TimedTrajectory) -> TrajectoryGoal:
    """Return the goal without its first point, which is where the robot is already."""
    points = trajectory.points[1:] or trajectory.points
    return TrajectoryGoal(
        joint_names=trajectory.joints,
        points=tuple(
            TrajectoryPoint(
                positions=point.positions,
                velocities=point.velocities,
                accelerations=point.accelerations,
                time_from_start_ns=point.time_from_start_ns,
            )
            for point in points
        ),
    )


def move_timeout_s(context: TaskContext, controller: str, duration_s: float) -> float:
    """Return the bound of a motion from acceptance to result: the stated one, or some more than it should take."""
    stated_s = goal_timeout_s(context.contract, controller)
    return 2.0 * duration_s + MARGIN_S if stated_s is None else stated_s
