"""The task node of one rehearsal: steps in order, one record for each, stopped by the first that fails."""

from __future__ import annotations

from cellc.contract.rehearsals import RehearsalEntry, StepEntry
from cellc.mock.engine.process import Waiting
from cellc.mock.record import AttemptRecord
from cellc.mock.stops import NORMAL
from cellc.mock.task.acknowledge import acknowledge
from cellc.mock.task.attempt import Attempt, Identity
from cellc.mock.task.context import TaskContext
from cellc.mock.task.detect import detect
from cellc.mock.task.grip import grip
from cellc.mock.task.move import move
from cellc.mock.task.outcome import AttemptError, Outcome

END_STEP = "end"


class Task:
    """Executes the steps of a rehearsal.

    Attributes:
        records: one for each attempt, and a last one that sums up.
        outcome: of the failure that ended the rehearsal, or succeeded: a stop that was acknowledged is in the records.
    """

    def __init__(self, rehearsal: RehearsalEntry, context: TaskContext) -> None:
        """Bind the task; ``context.deadline_ns`` is the bound of the whole rehearsal."""
        contract = context.plant.contract
        self.records: list[AttemptRecord] = []
        self.outcome = Outcome.SUCCEEDED
        self._rehearsal = rehearsal
        self._context = context
        self._identity = Identity(rehearsal.name, contract.configuration_id, contract.version_tuple)
        context.plant.control.listen(context.hear)

    def run(self) -> Waiting[None]:
        """Run the steps, up to the first failure; after a stop they go on, if the rehearsal has it acknowledged."""
        started_ns = self._context.now_ns
        failure: AttemptError | None = None
        for number, step in enumerate(self._rehearsal.steps, start=1):
            self._context.plant.progress.step = number
            attempt = Attempt(self._identity, number, _title(step), self._context.now_ns)
            failure = yield from self._attempt(attempt, step, failure)
            if failure is not None and not self._is_acknowledged_after(number):
                break
        summary = Attempt(self._identity, len(self.records) + 1, END_STEP, started_ns)
        self.outcome = self._close(summary, failure)

    def _attempt(self, attempt: Attempt, step: StepEntry, before: AttemptError | None) -> Waiting[AttemptError | None]:
        """Run one step; return why the rehearsal has failed by now, which an acknowledgment alone undoes."""
        failure: AttemptError | None = None
        try:
            yield from self._step(attempt, step, stopped=before is not None)
        except AttemptError as raised:
            failure = raised
        self._close(attempt, failure)
        return (failure or before) if step.kind != "acknowledge" else failure

    def _step(self, attempt: Attempt, step: StepEntry, *, stopped: bool) -> Waiting[None]:
        if self._context.plant.progress.announce("started"):
            yield from self._context.let_take_effect()
        if step.kind == "acknowledge":
            yield from acknowledge(self._context, attempt, step.target)
            return
        if step.kind == "wait" and stopped:
            yield from self._context.stand_by(step.duration_s or 0.0)
            return
        self._context.check_cell()
        if step.kind == "move":
            yield from move(self._context, attempt, step.target)
        elif step.kind == "detect":
            yield from detect(self._context, attempt, step.target)
        elif step.kind == "grip":
            yield from grip(self._context, attempt, step.target, step.command or "close")
        else:
            yield from self._context.rest(step.duration_s or 0.0)

    def _is_acknowledged_after(self, number: int) -> bool:
        later = self._rehearsal.steps[number:]
        return self._context.plant.stops.state() != NORMAL and any(step.kind == "acknowledge" for step in later)

    def _close(self, attempt: Attempt, failure: AttemptError | None) -> Outcome:
        safety_state = self._context.plant.stops.state()
        role = self._context.plant.contract.safety.acknowledge
        due = "none" if safety_state == NORMAL else f"required: acknowledge by {role}"
        outcome = Outcome.SUCCEEDED if failure is None else failure.outcome
        fault_code = "" if failure is None else failure.fault_code
        self.records.append(attempt.close(outcome, fault_code, safety_state, due, self._context.now_ns))
        return outcome


def _title(step: StepEntry) -> str:
    return " ".join(word for word in (step.kind, step.command or "", step.target) if word)
