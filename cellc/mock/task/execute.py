"""Sends a goal to an action, waits for its end, and holds the joints where it has to be canceled."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from cellc.contract.attempt import CancelRecord, PacketStep, ResultRecord
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.control import GoalStatus, GripperEnded, GripperGoal, TrajectoryEnded, TrajectoryGoal
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.plant import Plant
from cellc.mock.task.bounds import cancel_bound_s
from cellc.mock.task.context import Attempt, AttemptError, GoalEnded, TaskContext
from cellc.mock.task_status import CancelAsked
from cellc.mock.world.joint_states import JointStateHistory

RESPONSE_S = 1.0
"""How long a goal request may stay unanswered; a server answers within milliseconds or not at all."""

STANDSTILL = 1e-3
"""rad/s or m/s below which a joint is held; far below what a person sees and above what rounding makes."""
_LOOK_NS = 10_000_000
RESULT_GRACE_NS = 100_000_000
"""A controller that is deactivated sends the results of its goals immediately, or never: a client waits no longer for
them."""
_MOVED = 1e-9
"""rad or m: the least change of a joint that counts as having been driven."""


def await_response(context: TaskContext, server: str) -> Waiting[None]:
    """Return immediately where a server answers; raise AttemptError, timeout, where it does not within the bound."""
    if context.plant.network.answers(server):
        return
    yield from context.rest(RESPONSE_S)
    raise AttemptError(AttemptOutcome.TIMEOUT, f"no answer from {server} within {RESPONSE_S:g} s")


def cancel_and_hold(context: TaskContext, attempt: Attempt, goals: Sequence[SentGoal]) -> Waiting[bool]:
    """Cancel goals, and wait until their joints stand still or the bound has passed.

    The wait goes on whatever else is wrong with the cell: a hold is what every failure has to end in.

    Returns:
        Whether the joints were at standstill within the bound; the record of the attempt says when.
    """
    plant = context.plant
    requested_ns = plant.now_ns
    return_codes = [_cancel(plant, goal.controller, goal.goal_id) for goal in goals]
    for goal, return_code in zip(goals, return_codes, strict=True):
        if return_code == 0:
            plant.task.actions.tell(CancelAsked(goal.controller, goal.goal_id, requested_ns))
    joints = tuple(joint for goal in goals for joint in goal.joints)
    until_ns = requested_ns + round(cancel_bound_s(plant.contract) * 1e9)
    held_ns = held_since(plant, joints, requested_ns)
    while held_ns is None and plant.now_ns < until_ns:
        yield Wait(min(until_ns, plant.now_ns + _LOOK_NS), (plant.control.changed,))
        held_ns = held_since(plant, joints, requested_ns)
    latency_s = None if held_ns is None else (held_ns - requested_ns) / 1e9
    attempt.cancel = CancelRecord(requested_ns, held_ns, latency_s, return_codes[-1])
    while any(goal.key not in context.ended for goal in goals) and plant.now_ns < until_ns:
        yield Wait(min(until_ns, plant.now_ns + _LOOK_NS), (plant.control.changed,))
    return held_ns is not None


def _cancel(plant: Plant, controller: str, goal_id: int) -> int | None:
    """Ask to cancel a goal, or every goal where another client has one too; return the answer, None for no answer."""
    if not plant.network.answers(controller):
        return None
    manager = plant.control.server_of(controller)
    if plant.task.actions.is_shared(controller):
        return manager.cancel_all(controller).return_code
    return manager.cancel_goal(goal_id).return_code


def held_since(plant: Plant, joints: Iterable[str], since_ns: int) -> int | None:
    """Return the first stamp from ``since_ns`` on from which all joints stand still until now; None while they move."""
    stamps = [
        _history_held_since(history, [joint for joint in joints if joint in history.names], since_ns)
        for history in plant.control.histories.values()
        if any(joint in history.names for joint in joints)
    ]
    known = [stamp for stamp in stamps if stamp is not None]
    return max(known) if known and len(known) == len(stamps) else None


def _history_held_since(history: JointStateHistory, joints: list[str], since_ns: int) -> int | None:
    first = max(0, int(history.stamps.searchsorted(since_ns)) - 1)
    stamps = history.stamps[first:]
    if len(stamps) < 3:
        return None
    columns = [history.names.index(joint) for joint in joints]
    seconds = np.diff(stamps) / 1e9
    speeds = np.abs(np.diff(history.positions[first:, columns], axis=0)) / seconds[:, None]
    moving = np.flatnonzero(speeds.max(axis=1) > STANDSTILL)
    settled = int(moving[-1]) + 1 if moving.size else 0
    if settled >= len(seconds):
        return None
    return max(since_ns, int(stamps[settled]))


@dataclass(frozen=True, slots=True)
class SentGoal:
    """A goal that a controller has accepted, with the joints that it moves."""

    controller: str
    goal_id: int
    joints: tuple[str, ...]
    sent_ns: int

    @property
    def key(self) -> tuple[str, int]:
        """What its end is kept under."""
        return self.controller, self.goal_id


def execute(
    context: TaskContext,
    attempt: Attempt,
    kind: str,
    controller: str,
    goal: TrajectoryGoal | GripperGoal,
    timeout_s: float,
) -> Waiting[GoalEnded]:
    """Send a goal, and wait for its result, a cancel request, or the end of its time.

    Args:
        kind: kind of the step, which a cancel request names.
        timeout_s: bound from acceptance to result; then the goal is canceled and the joints are held.

    Returns:
        The result of a goal that its controller ended.

    Raises:
        AttemptError: the goal was rejected, canceled or not ended in time, or the cell stopped.
    """
    (ended,) = yield from execute_together(context, attempt, kind, {controller: goal}, timeout_s)
    return ended


def execute_together(
    context: TaskContext,
    attempt: Attempt,
    kind: str,
    goals: Mapping[str, TrajectoryGoal | GripperGoal],
    timeout_s: float,
) -> Waiting[tuple[GoalEnded, ...]]:
    """Send goals to several controllers at one instant, and wait for all results; one that fails ends them all.

    Arguments, results and errors are those of `execute`, with a goal for each controller.
    """
    context.check_cell()
    sent: list[SentGoal] = []
    try:
        for controller, goal in goals.items():
            goal_id = yield from _send(context, attempt, controller, goal)
            sent.append(SentGoal(controller, goal_id, joints_of(context.plant, controller), context.now_ns))
            context.node.actions.note_started(controller)
        context.node.milestones.announce("accepted")
        yield from _results(context, kind, sent, timeout_s)
    except AttemptError as failure:
        held = not sent or (yield from cancel_and_hold(context, attempt, sent))
        if failure.outcome is AttemptOutcome.CANCELED and not held:
            raise AttemptError(
                AttemptOutcome.TIMEOUT, "canceled, but the joints did not come to standstill in time"
            ) from None
        raise
    finally:
        for item in sent:
            note_result(context, attempt, item)
            context.node.requests.withdraw_cancel(kind)
            context.node.actions.note_ended(item.controller)
    attempt.controller_name = " and ".join(goals)
    return tuple(context.ended[goal.key] for goal in sent)


def require_success(ended: GoalEnded, context: TaskContext) -> None:
    """Raise AttemptError for the result of a trajectory that did not succeed."""
    if ended.status is GoalStatus.SUCCEEDED:
        return
    context.check_cell()
    if ended.status is GoalStatus.CANCELED:
        raise AttemptError(AttemptOutcome.CANCELED, "canceled by another client")
    if isinstance(ended, TrajectoryEnded):
        text = f"{ended.error_code}: {ended.error_string}"
        violated = ended.error_code in (-4, -5)  # PATH_ and GOAL_TOLERANCE_VIOLATED of FollowJointTrajectory
        # -1, INVALID_GOAL, is what a goal ends in that was replaced, or whose controller was deactivated.
        raise AttemptError(AttemptOutcome.TOLERANCE_VIOLATION if violated else AttemptOutcome.WRONG_OWNER, text)
    raise AttemptError(AttemptOutcome.TOLERANCE_VIOLATION, "gripper goal aborted before it was reached")


def _send(context: TaskContext, attempt: Attempt, controller: str, goal: TrajectoryGoal | GripperGoal) -> Waiting[int]:
    manager = context.control.server_of(controller)
    attempt.controller_name = controller
    attempt.speed_scaling = _speed_scaling(context.plant, controller)
    attempt.mark(PacketStep.GOAL_SENT, context.now_ns)
    attempt.action_goal_id = _goal_uuid(context.seed, attempt.attempt_id)
    yield from await_response(context, controller)
    response = context.control.send_goal(controller, goal, attempt.action_goal_id)
    if not response.accepted:
        raise AttemptError(AttemptOutcome.GOAL_REJECTION, response.log_reason)
    attempt.mark(PacketStep.ACCEPTED, context.now_ns)
    next_cycle_ns = (context.now_ns // manager.period_ns + 1) * manager.period_ns
    attempt.mark(PacketStep.WRITTEN, next_cycle_ns)
    return response.goal_id


def _results(context: TaskContext, kind: str, sent: Sequence[SentGoal], timeout_s: float) -> Waiting[None]:
    """Wait for the results of accepted goals; raise AttemptError where one has to be canceled instead."""
    until_ns = context.now_ns + round(timeout_s * 1e9)
    while waiting := [goal for goal in sent if goal.key not in context.ended]:
        for ended in (context.ended[goal.key] for goal in sent if goal not in waiting):
            require_success(ended, context)
        if context.node.requests.is_cancel_asked(kind):
            raise AttemptError(AttemptOutcome.CANCELED, f"the {kind} was canceled as requested")
        names = " and ".join(goal.controller for goal in waiting)
        if context.now_ns >= until_ns:
            raise AttemptError(AttemptOutcome.TIMEOUT, f"no result from {names} within {timeout_s:g} s")
        given_up_ns = require_active(context, waiting, until_ns)
        look_ns = min(look_for_motion(context, goal) for goal in waiting)
        signals = (context.node.requests.changed, context.node.actions.changed)
        yield from context.pause(min(until_ns, given_up_ns, look_ns), *signals)


def require_active(context: TaskContext, goals: Sequence[SentGoal], until_ns: int) -> int:
    """Return until when the results of goals may come: sooner than ``until_ns`` where a controller was deactivated.

    Raises:
        AttemptError: a result of a deactivated controller is overdue.
    """
    lost = {
        goal.controller: lost_ns + RESULT_GRACE_NS
        for goal in goals
        if (lost_ns := context.deactivated_ns.get(goal.controller)) is not None and lost_ns >= goal.sent_ns
    }
    given_up_ns = min(lost.values(), default=until_ns)
    if context.now_ns >= given_up_ns and lost:
        names = " and ".join(goal.controller for goal in goals)
        raise AttemptError(AttemptOutcome.WRONG_OWNER, f"{names} was deactivated while its goal was executing")
    return min(given_up_ns, until_ns)


def look_for_motion(context: TaskContext, goal: SentGoal) -> int:
    """Announce the first motion of a goal where somebody waits for it; return when to look again."""
    if not context.node.milestones.is_expected("moving"):
        return context.deadline_ns
    if _driven_ns(context.plant, goal.joints, goal.sent_ns) is not None:
        context.node.milestones.announce("moving")
    return context.now_ns + context.control.server_of(goal.controller).period_ns


def note_result(context: TaskContext, attempt: Attempt, goal: SentGoal) -> None:
    driven_ns = _driven_ns(context.plant, goal.joints, goal.sent_ns)
    if driven_ns is not None:
        attempt.mark(PacketStep.DRIVEN, driven_ns)
    ended = context.ended.get((goal.controller, goal.goal_id))
    if ended is None:
        return
    attempt.mark(PacketStep.RETURNED, ended.stamp_ns)
    code, text = (None, "stalled" if ended.stalled else "") if isinstance(ended, GripperEnded) else _error(ended)
    attempt.result = ResultRecord(ended.status.name.lower(), code, text, ended.stamp_ns)


def _error(ended: TrajectoryEnded) -> tuple[int, str]:
    return ended.error_code, ended.error_string


def _driven_ns(plant: Plant, joints: tuple[str, ...], since_ns: int) -> int | None:
    """Return the first stamp at which a joint is not where it was at ``since_ns``; None where none moved."""
    durations: list[int] = []
    for history in plant.control.histories.values():
        columns = [history.names.index(joint) for joint in joints if joint in history.names]
        first = max(0, int(history.stamps.searchsorted(since_ns, side="right")) - 1)
        positions = history.positions[first:, columns]
        if columns and len(positions):
            moved = np.flatnonzero(np.abs(positions - positions[0]).max(axis=1) > _MOVED)
            if moved.size:
                durations.append(int(history.stamps[first + int(moved[0])]))
    return min(durations) if durations else None


def joints_of(plant: Plant, controller: str) -> tuple[str, ...]:
    if controller in plant.contract.adapters:
        return plant.contract.adapters[controller].joints
    for manager in plant.contract.managers.values():
        if controller in manager.controllers:
            return manager.controllers[controller].joints
    raise AttemptError(AttemptOutcome.GOAL_REJECTION, f"no action server of controller {controller}")


def _speed_scaling(plant: Plant, controller: str) -> float | None:
    """Return the factor that the hardware reports; None for hardware without speed scaling."""
    for manager in plant.contract.managers.values():
        facts = manager.controllers.get(controller)
        if facts is None or facts.device is None:
            continue
        interface = plant.contract.devices[facts.device].speed_scaling_interface
        if interface is not None:
            value = plant.control.manager_of(controller).state(interface)
            return value if np.isfinite(value) else None
    return None


def _goal_uuid(seed: int, attempt_id: str) -> str:
    """Return an identifier in the form of a UUID (RFC 9562, version 8: free use), made of seed and attempt."""
    digest = hashlib.sha256(f"{seed}/{attempt_id}".encode()).hexdigest()
    return f"{digest[:8]}-{digest[8:12]}-8{digest[13:16]}-a{digest[17:20]}-{digest[20:32]}"
