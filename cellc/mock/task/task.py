"""The task of a rehearsal: its steps one after the other, each ending in a named outcome."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.contract.attempt import AttemptRecord, PacketStep
from cellc.contract.rehearsals import RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.bringup import activate
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.nodes.perception import DEFAULT_RATE_HZ
from cellc.mock.plant import Plant
from cellc.mock.stops import NORMAL
from cellc.mock.task.call import call
from cellc.mock.task.context import OUTCOME_OF_STOP, Attempt, AttemptError, Identity, TaskContext, current_state
from cellc.mock.task.grip import grip
from cellc.mock.task.mass import explained, require_untouched
from cellc.mock.task.move import move
from cellc.mock.task.switch import sense, switch

PATIENCE_PERIODS = 10
"""An observation that stays away for ten of its periods does not come."""

RECOVERY_S = 120.0
"""Where no KPI bounds the time from a stop to a cell that is ready."""
_LOOK_NS = 100_000_000
_FRESH_NS = 100_000_000
"""Joint states are watched that long before the cell is called ready."""
END_STEP = "end"


def detect(context: TaskContext, attempt: Attempt, frame: str) -> Waiting[None]:
    """Keep the stamp of the newest observation as soon as it is young enough.

    Raises:
        AttemptError: stale_state, where none is after ten periods.
    """
    inbox = context.node.observations.get(frame)
    entry = context.contract.frames.get(frame)
    if inbox is None or entry is None:
        raise AttemptError(AttemptOutcome.TF_FAILURE, f"no detector observes frame {frame}")
    attempt.goal_frame = frame
    period_ns = round(1e9 / (entry.rate_hz or DEFAULT_RATE_HZ))
    until_ns = context.now_ns + PATIENCE_PERIODS * period_ns
    while inbox.newest is None or inbox.is_stale(inbox.newest.stamp_ns):
        if context.now_ns >= until_ns:
            raise context.stale(frame, inbox.describe(frame))
        yield from context.pause(min(until_ns, context.now_ns + period_ns), inbox.arrived)
    context.observed[frame] = inbox.newest.stamp_ns
    attempt.goal_stamp = inbox.newest.stamp_ns
    attempt.mark(PacketStep.OBSERVED, inbox.newest.stamp_ns)


def acknowledge(context: TaskContext, attempt: Attempt, role: str) -> Waiting[None]:
    """Acknowledge the stops of a cell, activate what it needs, and look whether it is ready; no stop, nothing to do.

    Claims that were given up are taken again by the same person, as soon as the robot listens.

    Raises:
        AttemptError: the role may not acknowledge, what stopped the cell is not over in time, or it does not start.
    """
    plant = context.plant
    if not plant.stops.present() and not is_waiting(plant):
        return
    _require_role(plant, role)
    yield from _until_over(context)
    attempt.operator_intervention = f"acknowledged by {role}"
    plant.stops.recover(plant.now_ns)
    plant.effects.recover()
    yield from context.let_take_effect()
    problems = yield from _activate(plant)
    if problems:
        outcome = AttemptOutcome.CLAIM_FAILURE if plant.effects.refused else AttemptOutcome.HARDWARE_FAULT
        raise AttemptError(outcome, "; ".join(problems))
    yield from context.rest(_FRESH_NS / 1e9)
    current_state(plant)


def is_waiting(plant: Plant) -> bool:
    """Tell whether a claim waits for a person to take it again."""
    return bool(plant.watches.given_up or plant.effects.ignored)


def _require_role(plant: Plant, role: str) -> None:
    authorized = plant.contract.safety.acknowledge
    if role != authorized:
        stopped = plant.stops.present()
        outcome = OUTCOME_OF_STOP[stopped[0].state] if stopped else AttemptOutcome.CLAIM_FAILURE
        raise AttemptError(outcome, f"{role} must not acknowledge, only {authorized} may")


def _until_over(context: TaskContext) -> Waiting[None]:
    """Wait until what stopped the cell is over."""
    bound_s = context.contract.kpis.recovery_time_s or RECOVERY_S
    until_ns = min(context.now_ns + round(bound_s * 1e9), context.deadline_ns)
    plant = context.plant
    while (lasting := plant.stops.lasting()) or plant.effects.unrecoverable:
        if context.now_ns >= until_ns and lasting:
            text = f"{lasting[0].component} is still in {lasting[0].state} {bound_s:g} s after it should have recovered"
            raise AttemptError(OUTCOME_OF_STOP[lasting[0].state], text)
        if context.now_ns >= until_ns:
            text = f"{plant.effects.unrecoverable[0]} still follows no set points {bound_s:g} s after a claim request"
            raise AttemptError(AttemptOutcome.CLAIM_FAILURE, text)
        yield Wait(min(until_ns, context.now_ns + _LOOK_NS), (context.control.changed,))


def _activate(plant: Plant) -> Waiting[tuple[str, ...]]:
    """Activate the controllers that the contract has active and that are not: each holds the position that it reads."""
    problems: tuple[str, ...] = ()
    for name, entry in plant.contract.managers.items():
        states = {each.name: each.state for each in plant.control.managers[name].list_controllers()}
        here = {each: facts for each, facts in entry.controllers.items() if "mock" in facts.targets}
        waiting = tuple(each for each, facts in here.items() if facts.active and states[each] != "active")
        problems += yield from activate(plant, name, waiting)
    return problems


EXECUTED: Mapping[StepKind, Callable[[TaskContext, Attempt, StepEntry], Waiting[None]]] = {
    StepKind.MOVE: lambda context, attempt, step: move(
        context, attempt, step.target, together=step.command == "together"
    ),
    StepKind.DETECT: lambda context, attempt, step: detect(context, attempt, step.target),
    StepKind.GRIP: lambda context, attempt, step: grip(
        context, attempt, step.target, step.command or "close", step.part
    ),
    StepKind.SET: lambda context, _, step: switch(context, step.target, step.state or ""),
    StepKind.SENSE: lambda context, _, step: sense(context, step.target, step.state or ""),
    StepKind.CALL: lambda context, _, step: call(context, step.target),
    StepKind.WAIT: lambda context, _, step: context.rest(step.duration_s or 0.0),
    StepKind.ACKNOWLEDGE: lambda context, attempt, step: acknowledge(context, attempt, step.target),
}
"""What executes a kind of step."""


class Task:
    """Executes the steps of a rehearsal.

    Attributes:
        records: one for each attempt, and a last one that sums up.
        outcome: of the failure that ended the rehearsal, or succeeded: a stop that was acknowledged is in the records.
    """

    def __init__(self, rehearsal: RehearsalEntry, context: TaskContext) -> None:
        """Bind the task; ``context.deadline_ns`` is the bound of the whole rehearsal."""
        contract = context.contract
        self.records: list[AttemptRecord] = []
        self.outcome = AttemptOutcome.SUCCEEDED
        self._rehearsal = rehearsal
        self._context = context
        self._identity = Identity(rehearsal.name, contract.configuration_id, contract.version_tuple)
        context.control.listen(context.hear)

    def run(self) -> Waiting[None]:
        """Run the steps, up to the first failure; after a stop they go on, if the rehearsal has it acknowledged."""
        started_ns = self._context.now_ns
        failure: AttemptError | None = None
        for number, step in enumerate(self._rehearsal.steps, start=1):
            self._context.node.milestones.step = number
            attempt = self._identity.begin(number, step.title, self._context.now_ns)
            failure = yield from self._attempt(attempt, step, failure)
            if failure is not None and not self._is_acknowledged_after(number):
                break
        summary = self._identity.begin(len(self.records) + 1, END_STEP, started_ns)
        self.outcome = self._close(summary, failure)

    def _attempt(self, attempt: Attempt, step: StepEntry, before: AttemptError | None) -> Waiting[AttemptError | None]:
        """Run one step; return why the rehearsal has failed by now, which an acknowledgment alone undoes."""
        failure: AttemptError | None = None
        started_ns = self._context.now_ns
        try:
            yield from self._step(attempt, step, stopped=before is not None)
            require_untouched(self._context, started_ns)
        except AttemptError as raised:
            canceled_ns = None if attempt.cancel is None else attempt.cancel.requested_ns
            failure = explained(self._context, raised, started_ns, canceled_ns)
        self._close(attempt, failure)
        return (failure or before) if step.kind is not StepKind.ACKNOWLEDGE else failure

    def _step(self, attempt: Attempt, step: StepEntry, *, stopped: bool) -> Waiting[None]:
        if self._context.node.milestones.announce("started"):
            yield from self._context.let_take_effect()
        if step.kind is StepKind.WAIT and stopped:
            yield from self._context.stand_by(step.duration_s or 0.0)
            return
        if step.kind is not StepKind.ACKNOWLEDGE:
            self._context.check_cell()
        yield from EXECUTED[step.kind](self._context, attempt, step)

    def _is_acknowledged_after(self, number: int) -> bool:
        later = self._rehearsal.steps[number:]
        stopped = self._context.plant.stops.state() != NORMAL or is_waiting(self._context.plant)
        return stopped and any(step.kind is StepKind.ACKNOWLEDGE for step in later)

    def _close(self, attempt: Attempt, failure: AttemptError | None) -> AttemptOutcome:
        safety_state = self._context.plant.stops.state()
        role = self._context.contract.safety.acknowledge
        due = "none" if safety_state == NORMAL else f"required: acknowledge by {role}"
        if safety_state == NORMAL and is_waiting(self._context.plant):
            due = f"required: program start, then a claim, by {role}"
        outcome = AttemptOutcome.SUCCEEDED if failure is None else failure.outcome
        fault_code = "" if failure is None else failure.fault_code
        record = attempt.close(outcome, fault_code, safety_state, due, self._context.now_ns)
        self.records.append(record)
        self._context.node.actions.tell(record)
        return outcome
