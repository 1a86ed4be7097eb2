"""What a rehearsal ends with: its result, and the lines that its attempt records are written as.

No wall-clock time enters a record, so that two runs give the same bytes.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import fields
from typing import Any

from cellc.contract.attempt import AttemptRecord
from cellc.contract.diagnostics.notebook import html_table
from cellc.contract.diagnostics.unsafe_text import escaped, harmless_json
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import AttemptOutcome, Term


def to_json_line(record: AttemptRecord) -> str:
    """Return a record as one line of JSON; floats have the shortest text that reads back to the same value."""
    text = json.dumps(record, default=_by_field, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return harmless_json(text)


def _by_field(record: Any) -> dict[str, object]:
    return {field.name: getattr(record, field.name) for field in fields(record)}


def to_json_lines(records: Iterable[AttemptRecord]) -> str:
    """Return records as JSON lines, each ended by a newline."""
    return "".join(to_json_line(record) + "\n" for record in records)


class RunFailure(Term):
    """How a rehearsal ends that comes to no outcome of an attempt; no rehearsal expects it."""

    BRINGUP_FAILURE = "bringup_failure"
    CRASHED = "crashed"
    LIMIT_REACHED = "limit_reached"


RunOutcome = AttemptOutcome | RunFailure


@dataclass(frozen=True, slots=True)
class StageEvidence:
    """One stage of the bring-up: discover, configure, observe or claim.

    Attributes:
        facts: what was seen, one line each.
        problems: why the stage failed, in the words of the control stack; empty where it passed.
    """

    stage: str
    facts: tuple[str, ...]
    problems: tuple[str, ...]

    @property
    def passed(self) -> bool:
        """Tell whether the next stage may begin."""
        return not self.problems


@dataclass(frozen=True, slots=True)
class Contact:
    """Two bodies with masses, and the largest force with which they pressed on each other, N."""

    one: str
    other: str
    most_n: float
    at_ns: int

    def __str__(self) -> str:
        return f"{self.one} and {self.other} press with up to {self.most_n:.3g} N, at {self.at_ns / 1e9:.3f} s"


@dataclass(frozen=True, slots=True, repr=False)
class RehearsalResult:
    """The end of one rehearsal with its evidence; nothing in it depends on the host or the hour.

    Attributes:
        outcome: of the failure that ended it, or succeeded; a run failure where the cell never started.
        sim_time_s: simulated time from the end of the bring-up to the end.
        response_s: simulated time from the fault taking effect to the bounded end; None without a fault.
        within_s: bound of ``response_s``, or None.
        findings: what was odd, such as endpoints that do not connect or a second authority of a frame.
        edited: the folder was not as its manifest has it, so that this is evidence of no configuration.
        unseen: links with a shape whose mesh is not there: nothing checked whether they touch anything.
        violations: what nodes under test did against the contract, one line each.
        vacuous: it shows nothing of a fault, which never began although no other one ended the run; a finding says why.
        contacts: what pressed on what since the task began, the hardest first; empty where nothing has a mass.
    """

    name: str
    outcome: RunOutcome
    expected: AttemptOutcome
    sim_time_s: float
    response_s: float | None
    within_s: float | None
    attempts: tuple[AttemptRecord, ...]
    bringup: tuple[StageEvidence, ...]
    findings: tuple[str, ...]
    vacuous: bool = False
    contacts: tuple[Contact, ...] = ()
    edited: bool = False
    unseen: tuple[str, ...] = ()
    violations: tuple[str, ...] = ()

    @property
    def reason(self) -> str:
        """Which step ended the rehearsal, and why; empty after a plain success."""
        for stage in self.bringup:
            if stage.problems:
                return f"bring-up, {stage.stage}: {'; '.join(stage.problems)}"
        *attempts, end = self.attempts or (None,)
        if end is None or not end.fault_code:
            return ""
        number = max(
            (at for at, attempt in enumerate(attempts, 1) if attempt and attempt.fault_code == end.fault_code),
            default=0,
        )
        return f"{self._step(number)}: {end.fault_code}" if number else end.fault_code

    def _step(self, number: int) -> str:
        """Name a step as the spec does, such as ``step 8 `move: pick` ``."""
        kind, _, target = self.attempts[number - 1].step.partition(" ")
        return f"step {number} `{kind}{': ' if target else ''}{target}`"

    @property
    def title(self) -> str:
        """The name, with what is unlike other runs."""
        return f"{self.name} of an edited folder" if self.edited else self.name

    @property
    def in_time(self) -> bool:
        """Tell whether the bound was held, where there is one."""
        return self.within_s is None or (self.response_s is not None and self.response_s <= self.within_s)

    @property
    def passed(self) -> bool:
        """Tell whether the rehearsal met its faults and its contract, and ended as expected and within its bound."""
        return self.outcome == self.expected and self.in_time and not self.vacuous and not self.violations

    def __repr__(self) -> str:
        text = f"{self.outcome.value} (expected {self.expected.value}), {self.sim_time_s:.2f} s simulated"
        return escaped(f"<RehearsalResult {self.title}: {text}>")

    def _repr_html_(self) -> str:
        rows = (
            (
                attempt.step,
                attempt.outcome.value,
                f"{(attempt.ended_ns - attempt.started_ns) / 1e9:.2f}",
                attempt.fault_code,
            )
            for attempt in self.attempts
        )
        return html_table(repr(self).strip("<>"), ("step", "outcome", "s simulated", "reason"), rows)


def simulated_s(results: Iterable[RehearsalResult]) -> float:
    """Return how much time several rehearsals simulated."""
    return sum(result.sim_time_s for result in results)
