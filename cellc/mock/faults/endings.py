"""What becomes of steps that meet a fault, and how soon the watchdogs of a cell end them, as its contract states."""

from __future__ import annotations

from collections.abc import Callable

from cellc.contract.bring_up import WATCH_WITHIN_S
from cellc.contract.contract import Contract
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.faults.cases import BORNE, CellStep, Ending, device_of, ends_in
from cellc.mock.nodes.motion_planner import PLANNING_LATENCY_S
from cellc.mock.nodes.observations import DEFAULT_MAX_AGE_S as DEFAULT_OBSERVATION_AGE_S
from cellc.mock.nodes.perception import DEFAULT_RATE_HZ, POSE_TYPE
from cellc.mock.stops import recovery_state
from cellc.mock.task.bounds import action_timeout_s, cancel_bound_s, goal_timeout_s, grip_timeout_s, joint_state_age_s
from cellc.mock.task.context import OUTCOME_OF_STOP
from cellc.mock.task.move import TF_TIMEOUT_S
from cellc.mock.task.task import PATIENCE_PERIODS
from cellc.mock.task.watch import WATCH_S

MONITOR_S = 0.05
"""Result of an action at the default `action_monitor_rate` of 20 Hz: so much later than it was decided."""
SETTLE_S = 0.02
"""A few update cycles: until a request to a controller manager is carried out and its event has come back."""

StepEnding = Callable[[CellStep], Ending]
"""Says of each step of a cell how it may end that meets a fault."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """Bounds of one cell, each from the effect of a fault to the end of the step that meets it."""

    contract: Contract

    def hold_s(self) -> float:
        """Return the bound of what the control stack reports: the attempt ends immediately and its joints are held."""
        return SETTLE_S + MONITOR_S + cancel_bound_s(self.contract)

    def watched_s(self) -> float:
        """Return the bound of what the task has to look for itself."""
        return WATCH_S + self.hold_s()

    def asked_s(self) -> float:
        """Return the bound of a refusal: planning, its transforms, and the answer to a goal."""
        return TF_TIMEOUT_S + PLANNING_LATENCY_S + self.hold_s()

    def refused_s(self, step: CellStep) -> float | None:
        """Return the bound of a refusal in a step: where several groups move in turn, others may have moved before."""
        return self.asked_s() if len(step.controllers) < 2 else self.execution_s(step)

    def joint_state_s(self) -> float:
        """Return the bound of joint states that stay away."""
        return joint_state_age_s(self.contract) + PLANNING_LATENCY_S + self.watched_s()

    def observation_s(self, frame: str) -> float:
        """Return the bound of observations that stay away while somebody waits for them or acts on one."""
        period_s = 1.0 / (self.contract.frames[frame].rate_hz or DEFAULT_RATE_HZ)
        return max(PATIENCE_PERIODS * period_s, self.observation_age_s(frame)) + period_s + self.watched_s()

    def execution_s(self, step: CellStep) -> float | None:
        """Return the bound of a goal that makes no progress; None where no action of the contract states one."""
        if step.kind == "grip":
            return sum(grip_timeout_s(self.contract, controller) for controller in step.controllers) + self.asked_s()
        goals = [goal_timeout_s(self.contract, controller) for controller in step.controllers]
        stated = [timeout_s for timeout_s in goals or [action_timeout_s(self.contract)] if timeout_s is not None]
        return sum(stated) + self.asked_s() if len(stated) == max(1, len(goals)) else None

    def dynamic_frames(self) -> tuple[str, ...]:
        """Return the frames that somebody has to observe."""
        return tuple(name for name, frame in self.contract.frames.items() if frame.kind == "dynamic")

    def observation_age_s(self, frame: str) -> float:
        """Return how old an observation may be."""
        stated = [
            interface.max_age_s
            for interface in self.contract.interfaces.values()
            if interface.type == POSE_TYPE and interface.frame == self.contract.frames[frame].parent
        ]
        return max((age for age in stated if age is not None), default=DEFAULT_OBSERVATION_AGE_S)


def unobserved(bounds: Bounds, frames: tuple[str, ...]) -> StepEnding:
    """Return how steps end while nothing new is seen of ``frames``.

    A step that does not look itself is affected as long as the cell is where an observation has led it.
    """

    def ending(step: CellStep) -> Ending:
        if not frames:
            return BORNE
        within_s = max(map(bounds.observation_s, frames))
        if step.observes in frames:
            return ends_in(AttemptOutcome.STALE_STATE, within_s=within_s)
        return ends_in(AttemptOutcome.STALE_STATE, AttemptOutcome.SUCCEEDED, within_s=within_s)

    return ending


def stateless(bounds: Bounds) -> StepEnding:
    """Return how steps end while joint states stay away: one that sends no goal bears it."""
    return lambda step: (
        ends_in(AttemptOutcome.STALE_STATE, within_s=bounds.joint_state_s()) if step.controllers else BORNE
    )


def off_track(bounds: Bounds, controller: str, *more: AttemptOutcome) -> StepEnding:
    """Return how steps end when a joint of ``controller`` is off its track.

    A step that leaves the joint where it is bears it, unless it grips. Without a goal time, as of a gripper, the
    controller may wait for ever, and the client ends the goal.

    Args:
        more: outcomes that this fault may have besides.
    """
    patience = () if _goal_time_s(bounds.contract, controller) else ("timeout",)

    def ending(step: CellStep) -> Ending:
        if controller not in step.controllers:  # the fingers of an arm that is elsewhere meet nothing
            return ends_in(AttemptOutcome.SUCCEEDED, *gripped(step), within_s=bounds.execution_s(step))
        return ends_in(
            AttemptOutcome.TOLERANCE_VIOLATION,
            AttemptOutcome.SUCCEEDED,
            *gripped(step),
            *patience,
            *more,
            within_s=bounds.execution_s(step),
        )

    return ending


def gripped(step: CellStep) -> tuple[AttemptOutcome, ...]:
    """Return what a step besides ends in that closes a gripper whose fingers do not come to the part."""
    return (AttemptOutcome.GRIP_FAILURE,) if step.kind == "grip" else ()


def _goal_time_s(contract: Contract, controller: str) -> float | None:
    """Return the time that a controller or adapter allows past the end of a trajectory; None or zero for no limit."""
    if controller in contract.adapters:
        return contract.adapters[controller].goal_time_s
    controllers = (manager.controllers.get(controller) for manager in contract.managers.values())
    return next((entry.goal_time_s for entry in controllers if entry is not None), None)


def stopped_in(bounds: Bounds, device: str, state: str) -> StepEnding:
    """Return how steps end when a device stops in a state of its own: as soon as the cell hears of it, if it does.

    A stop that no topic reports is noticed by a goal that gets nowhere.
    """
    contract, outcome = bounds.contract, OUTCOME_OF_STOP[recovery_state(state)]
    stop, facts = contract.devices[device].stops[state], contract.devices[device]
    if device in contract.adapters or stop.leaves != "active":
        return stopped(bounds, outcome)
    if set(stop.ends) & set(facts.reports):
        return stopped(bounds, outcome, WATCH_WITHIN_S)
    return unfollowed(bounds, device)


def unfollowed(bounds: Bounds, device: str, *more: AttemptOutcome) -> StepEnding:
    """Return how steps end when a device follows nothing and says nothing: those that move it get nowhere.

    Args:
        more: outcomes that this fault may have besides.
    """

    def ending(step: CellStep) -> Ending:
        if not any(device_of(bounds.contract, name) == device for name in step.controllers):
            return ends_in(*more, AttemptOutcome.SUCCEEDED, within_s=None) if more else BORNE
        outcomes = (AttemptOutcome.TOLERANCE_VIOLATION, AttemptOutcome.TIMEOUT, AttemptOutcome.SUCCEEDED, *more)
        return ends_in(*outcomes, *gripped(step), within_s=bounds.execution_s(step))

    return ending


def stopped(bounds: Bounds, outcome: AttemptOutcome, after_s: float = 0.0) -> StepEnding:
    """Return how steps end when a device stops ``after_s`` after the fault began: whichever device they move."""
    ending = ends_in(outcome, within_s=after_s + bounds.hold_s())
    return lambda step: ending
