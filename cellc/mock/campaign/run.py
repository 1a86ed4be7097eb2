"""One run of a campaign: which faults, at which steps, and how it may end."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock.campaign.limits_report import LimitsReport
from cellc.mock.result import RehearsalResult

SUCCEEDED = "succeeded"


@dataclass(frozen=True, slots=True)
class Hit:
    """A fault at a step.

    Attributes:
        fault: kind and target, joined by a colon.
        step: number of the step, from 1.
        when: how far the step has come: started, accepted or moving.
    """

    fault: str
    step: int
    when: str

    def __str__(self) -> str:
        return f"{self.fault}@{self.step}" if self.when == "started" else f"{self.fault}@{self.step}.{self.when}"


@dataclass(frozen=True, slots=True)
class CampaignRun:
    """A rehearsal with faults added, and the endings that count as named.

    Attributes:
        rehearsal: name of the rehearsal that it is made of; ``entry`` is named by the run's identifier.
        outcomes: names of the outcomes that it may end in, sorted.
        within_s: bound of the response where it does not succeed; None where the rehearsal's timeout is the bound.
    """

    rehearsal: str
    hits: tuple[Hit, ...]
    entry: RehearsalEntry
    outcomes: tuple[str, ...]
    within_s: float | None

    @classmethod
    def undisturbed(cls, entry: RehearsalEntry) -> CampaignRun:
        """Return the run of a rehearsal as it stands, which has to succeed."""
        return cls(entry.name, (), entry, (SUCCEEDED,), None)

    @property
    def identifier(self) -> str:
        """Name that ``--replay`` takes: ``REHEARSAL/KIND:TARGET@STEP``, further faults after a plus sign."""
        return self.entry.name


@dataclass(frozen=True, slots=True)
class RunEnd:
    """How a run ended.

    Attributes:
        crash: the last line of the traceback where the mock itself failed, which is a bug; empty else.
        digest: over the attempt records and every commanded sample, so that a replay can be compared bit for bit.
    """

    run: CampaignRun
    result: RehearsalResult
    limits: LimitsReport
    digest: str
    crash: str = ""

    @property
    def named(self) -> bool:
        """Tell whether it ended in an outcome that this fault may have."""
        return not self.crash and self.result.outcome in self.run.outcomes

    @property
    def in_time(self) -> bool:
        """Tell whether the bound was held; a fault that was borne, or never met, needs no response."""
        if self.run.within_s is None or self.result.outcome == SUCCEEDED:
            return True
        return self.result.response_s is not None and self.result.response_s <= self.run.within_s

    @property
    def passed(self) -> bool:
        """Tell whether the run is as it must be."""
        return self.named and self.in_time and self.limits.held
