"""A move step: plan to a named pose or a goal, and execute on the controller of the group."""

from __future__ import annotations

from cellc.contract.contract import ContractPoseTarget
from cellc.mock.control import TrajectoryGoal, TrajectoryPoint
from cellc.mock.engine.process import Waiting
from cellc.mock.nodes.motion_planner import PLANNING_LATENCY_S
from cellc.mock.nodes.motion_request import PlannedMotion
from cellc.mock.record import PacketStep
from cellc.mock.task.arrival import state_since
from cellc.mock.task.attempt import Attempt
from cellc.mock.task.bounds import action_timeout_s, planning_server
from cellc.mock.task.context import TaskContext
from cellc.mock.task.execute import execute, require_success
from cellc.mock.task.goal_frame import check_observation, locate_goal
from cellc.mock.task.joint_state import CurrentState, current_state
from cellc.mock.task.outcome import AttemptError, Outcome
from cellc.mock.task.response import await_response
from cellc.planning import PlanFailure, TimedTrajectory

ARRIVAL_TOLERANCE = 0.05
"""rad or m by which a joint may miss the end of a trajectory that its controller calls a success."""
MARGIN_S = 10.0
"""Beyond twice the planned duration: the bound of an execution where no action of the contract states one."""


def move(context: TaskContext, attempt: Attempt, target: str) -> Waiting[None]:
    """Move to a named pose, group after group, or to a goal; raise AttemptError where it does not get there."""
    contract = context.plant.contract
    if target in contract.poses:
        for pose in contract.poses[target]:
            yield from _move_to_pose(context, attempt, pose)
    elif target in contract.goals:
        yield from _move_to_goal(context, attempt, target)
    else:
        raise AttemptError(Outcome.PLANNING_FAILURE, f"neither a pose nor a goal is named {target}")


def _move_to_pose(context: TaskContext, attempt: Attempt, pose: ContractPoseTarget) -> Waiting[None]:
    state = current_state(context.plant)
    attempt.joint_state_age = state.age_s
    retreat = context.retreats.get(pose.group)
    planned = context.plant.planner.plan(pose.group, state.positions, pose.positions, retreat)
    motion = yield from _planning_time(context, attempt, planned)
    yield from _drive(context, attempt, pose.group, motion, None)


def _move_to_goal(context: TaskContext, attempt: Attempt, name: str) -> Waiting[None]:
    group = context.plant.contract.goals[name].group
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
    yield from _drive(context, attempt, group, motion, located.observed_frame)


def _planning_time(
    context: TaskContext, attempt: Attempt, planned: PlannedMotion | PlanFailure
) -> Waiting[PlannedMotion]:
    """Let the simulated time of planning pass, then answer."""
    yield from await_response(context, planning_server(context.plant.contract))
    until_ns = context.now_ns + round(PLANNING_LATENCY_S * 1e9)
    while context.now_ns < until_ns:
        yield from context.pause(until_ns)
    attempt.mark(PacketStep.PLANNED, context.now_ns)
    if isinstance(planned, PlanFailure):
        attempt.plan_result = f"{planned.reason.value}: {planned.detail}"
        raise AttemptError(Outcome.PLANNING_FAILURE, attempt.plan_result)
    attempt.plan_result = "success"
    return planned


def _drive(
    context: TaskContext, attempt: Attempt, group: str, motion: PlannedMotion, observed_frame: str | None
) -> Waiting[None]:
    """Check the state once more and execute; the arm stands at a goal afterwards, or no longer at one."""
    current_state(context.plant)
    controller = context.plant.contract.groups[group].controller
    if controller is None:
        raise AttemptError(Outcome.GOAL_REJECTION, f"no controller moves group {group}")
    context.retreats.pop(group, None)
    context.acting_on = observed_frame
    goal = _trajectory_goal(motion.trajectory)
    timeout_s = _timeout_s(context, motion.trajectory.duration_ns * 1e-9)
    ended = yield from execute(context, attempt, "move", controller, goal, timeout_s)
    require_success(ended, context)
    state = yield from state_since(context, ended.decided_ns)
    _require_arrival(state, motion.trajectory)
    if motion.retreat is not None:
        context.retreats[group] = motion.retreat


def _require_arrival(state: CurrentState, trajectory: TimedTrajectory) -> None:
    """Raise AttemptError where a joint is elsewhere: a controller without tolerances reports success all the same."""
    actual = state.positions
    for joint, goal in zip(trajectory.joints, trajectory.points[-1].positions, strict=True):
        if abs(actual[joint] - goal) > ARRIVAL_TOLERANCE:
            text = f"joint {joint} stands at {actual[joint]:.4g} after a reported success, its goal is {goal:.4g}"
            raise AttemptError(Outcome.TOLERANCE_VIOLATION, text)


def _trajectory_goal(trajectory: TimedTrajectory) -> TrajectoryGoal:
    """Return the goal without its first point, which is where the robot stands already."""
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


def _timeout_s(context: TaskContext, duration_s: float) -> float:
    stated_s = action_timeout_s(context.plant.contract)
    return 2.0 * duration_s + MARGIN_S if stated_s is None else stated_s
