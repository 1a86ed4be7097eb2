"""What a rehearsal ends with."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.record import AttemptRecord

BRINGUP_FAILURE = "bringup_failure"
"""Outcome of a rehearsal whose cell never came up; no rehearsal can expect it."""


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
class RehearsalResult:
    """The end of one rehearsal with its evidence; nothing in it depends on the host or the hour.

    Attributes:
        outcome: name of the outcome, or ``bringup_failure``.
        sim_time_s: simulated time from the end of the bring-up to the end.
        response_s: simulated time from the fault taking effect to the bounded end; None without a fault.
        within_s: bound of ``response_s``; None where there is none.
        findings: what was odd, such as endpoints that do not connect or a second authority of a frame.
        vacuous: it shows nothing of a fault, which never began although no other one ended the run; a finding says why.
    """

    name: str
    outcome: str
    expected: str
    sim_time_s: float
    response_s: float | None
    within_s: float | None
    attempts: tuple[AttemptRecord, ...]
    bringup: tuple[StageEvidence, ...]
    findings: tuple[str, ...]
    vacuous: bool = False

    @property
    def in_time(self) -> bool:
        """Tell whether the bound was held, where there is one."""
        return self.within_s is None or (self.response_s is not None and self.response_s <= self.within_s)

    @property
    def passed(self) -> bool:
        """Tell whether the rehearsal met its faults, and ended as expected and within its bound."""
        return self.outcome == self.expected and self.in_time and not self.vacuous
