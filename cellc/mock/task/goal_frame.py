"""The goal of a move in the base of its group: looked up at the stamp of the observation, never at the latest time."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.contract.contract import Contract, ContractGoal
from cellc.mock.engine.process import Waiting
from cellc.mock.nodes.motion_request import GoalPose
from cellc.mock.record import PacketStep
from cellc.mock.task.attempt import Attempt
from cellc.mock.task.context import TaskContext
from cellc.mock.task.joint_state import current_state
from cellc.mock.task.outcome import AttemptError, Outcome
from cellc.mock.tf.buffer import Transform
from cellc.transforms import Pose

TF_TIMEOUT_S = 0.2
"""How long a lookup waits for transforms that are on their way: four intervals of robot_state_publisher."""


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
    contract = context.plant.contract
    entry = contract.goals[name]
    base = contract.groups[entry.group].base_link
    observed_frame = dynamic_ancestor(contract, entry.frame)
    stamp_ns = _stamp(context, entry, base, observed_frame, state_stamp_ns)
    attempt.goal_frame, attempt.goal_stamp = entry.frame, stamp_ns
    attempt.calibration_id = _calibrations(context, base, entry)
    if observed_frame is not None:
        attempt.mark(PacketStep.OBSERVED, stamp_ns)
    transform = yield from _lookup(context, base, entry.frame, stamp_ns)
    attempt.tf_lookup_age = context.plant.clocks.age_ns(context.plant.task, stamp_ns) / 1e9
    attempt.mark(PacketStep.TRANSFORMED, context.now_ns)
    dx, dy, dz = context.plant.requests.displaced.get(name, (0.0, 0.0, 0.0))
    displaced = Pose((dx, dy, dz), (0.0, 0.0, 0.0, 1.0)) @ Pose(entry.pose.xyz, entry.pose.quaternion)
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
        latest = context.plant.buffer.latest_ns(base, entry.frame)
        return state_stamp_ns if latest is None else latest
    if observed_frame is None:
        latest = context.plant.buffer.latest_ns(base, entry.frame)
        return state_stamp_ns if latest is None else min(latest, state_stamp_ns)
    if observed_frame not in context.observed:
        raise AttemptError(Outcome.STALE_STATE, f"frame {observed_frame} was never observed")
    stamp_ns = context.observed[observed_frame]
    check_observation(context, observed_frame, stamp_ns)
    return stamp_ns


def check_observation(context: TaskContext, frame: str, stamp_ns: int, allowance_s: float = 0.0) -> None:
    """Raise AttemptError where an observation is too old to act on.

    Args:
        allowance_s: time that planning has taken since the observation was checked first.
    """
    inbox = context.plant.inboxes.get(frame)
    if inbox is not None and inbox.is_stale(stamp_ns, allowance_s):
        text = f"observation of {frame} is {inbox.age_s(stamp_ns):.3f} s old, {inbox.max_age_s:g} s allowed"
        raise AttemptError(Outcome.STALE_STATE, text)


def _lookup(context: TaskContext, target: str, source: str, stamp_ns: int) -> Waiting[Transform]:
    """Look a transform up; a stamp that is ahead of the buffer is waited for, within a bound."""
    until_ns = context.now_ns + round(TF_TIMEOUT_S * 1e9)
    while True:
        context.plant.robot_state_publisher.catch_up(context.now_ns)
        context.check_authorities(context.plant.buffer.path(target, source))
        answer = context.plant.buffer.lookup(target, source, stamp_ns)
        if isinstance(answer, Transform):
            return answer
        if not answer.kind.may_pass or context.now_ns >= until_ns:
            current_state(context.plant)  # joint states that stay away are the cause, transforms only follow them
            raise AttemptError(Outcome.TF_FAILURE, answer.text)
        yield from context.pause(min(until_ns, context.now_ns + 5_000_000))


def _calibrations(context: TaskContext, base: str, entry: ContractGoal) -> tuple[str, ...]:
    """Return the calibrations, with revision, of every edge between base and goal, and between base and tip."""
    contract = context.plant.contract
    edges = {
        *context.plant.buffer.path(base, entry.frame),
        *context.plant.buffer.path(base, contract.groups[entry.group].tip_frame),
    }
    ids = {contract.frames[edge].calibration for edge in edges if edge in contract.frames}
    return tuple(
        f"{name}:{contract.calibrations[name].revision}"
        for name in sorted(name for name in ids if name is not None)
        if name in contract.calibrations
    )
