"""The task node of one rehearsal: steps in order, one record for each, stopped by the first that fails."""

from __future__ import annotations

from cellc.contract.rehearsals import RehearsalEntry, StepEntry
from cellc.mock.engine.process import Waiting
from cellc.mock.record import AttemptRecord
from cellc.mock.task.attempt import Attempt, Identity
from cellc.mock.task.context import NORMAL, TaskContext
from cellc.mock.task.detect import detect
from cellc.mock.task.grip import grip
from cellc.mock.task.move import move
from cellc.mock.task.outcome import AttemptError, Outcome

END_STEP = "end"


class Task:
    """Executes the steps of a rehearsal.

    Attributes:
        records: one for each attempt, and a last one that sums up.
        outcome: of the first attempt that failed, or succeeded.
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
        """Run all steps."""
        started_ns = self._context.now_ns
        fault_code = ""
        for number, step in enumerate(self._rehearsal.steps, start=1):
            attempt = Attempt(self._identity, number, _title(step), self._context.now_ns)
            self._context.plant.progress.step = number
            try:
                yield from self._step(attempt, step)
            except AttemptError as failure:
                self.outcome, fault_code = failure.outcome, failure.fault_code
            self._close(attempt, fault_code)
            if self.outcome is not Outcome.SUCCEEDED:
                break
        self._close(Attempt(self._identity, len(self.records) + 1, END_STEP, started_ns), fault_code)

    def _step(self, attempt: Attempt, step: StepEntry) -> Waiting[None]:
        if self._context.plant.progress.announce("started"):
            yield from self._context.let_take_effect()
        self._context.check_cell()
        if step.kind == "move":
            yield from move(self._context, attempt, step.target)
        elif step.kind == "detect":
            yield from detect(self._context, attempt, step.target)
        elif step.kind == "grip":
            yield from grip(self._context, attempt, step.target, step.command or "close")
        else:
            until_ns = self._context.now_ns + round((step.duration_s or 0.0) * 1e9)
            while self._context.now_ns < until_ns:
                yield from self._context.pause(until_ns)

    def _close(self, attempt: Attempt, fault_code: str) -> None:
        safety_state = self._context.safety_state()
        safety = self._context.plant.contract.safety
        intervention = "none" if safety_state == NORMAL else f"required: acknowledge by {safety.acknowledge}"
        self.records.append(attempt.close(self.outcome, fault_code, safety_state, intervention, self._context.now_ns))


def _title(step: StepEntry) -> str:
    return " ".join(word for word in (step.kind, step.command or "", step.target) if word)
