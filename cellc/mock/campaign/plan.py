"""The runs of a campaign: faults that begin with steps of rehearsals, alone or in pairs, and how each may end."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from cellc.contract.attempt import PacketStep
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import RehearsalEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.campaign.limits import LimitsReport
from cellc.mock.faults.cases import FaultCase
from cellc.mock.result import RehearsalResult

_JOINED = "+"


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
        outcomes: those that it may end in, sorted.
        within_s: bound of the response where it does not succeed; None where the rehearsal's timeout is the bound.
    """

    rehearsal: str
    hits: tuple[Hit, ...]
    entry: RehearsalEntry
    outcomes: tuple[AttemptOutcome, ...]
    within_s: float | None

    @classmethod
    def undisturbed(cls, entry: RehearsalEntry) -> CampaignRun:
        """Return the run of a rehearsal as it is, which has to succeed."""
        return cls(entry.name, (), entry, (AttemptOutcome.SUCCEEDED,), None)

    def within(self, within_s: float) -> CampaignRun:
        """Return the same run with another bound."""
        return replace(self, entry=self.entry.model_copy(update={"within_s": within_s}), within_s=within_s)

    @property
    def identifier(self) -> str:
        """Name that ``cellc replay`` takes: ``REHEARSAL/KIND:TARGET@STEP``, further faults after a plus sign."""
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
        if self.run.within_s is None or self.result.outcome == AttemptOutcome.SUCCEEDED:
            return True
        return self.result.response_s is not None and self.result.response_s <= self.run.within_s

    @property
    def passed(self) -> bool:
        """Tell whether the run is as it must be."""
        return self.named and self.in_time and self.limits.held and not self.result.violations


class CampaignPlan:
    """The runs of the faults of a cell over the steps of its rehearsals.

    Args:
        cases: the faults that the cell can meet.
        baselines: ends of the rehearsals without faults; they tell which steps move anything.
    """

    def __init__(self, cases: Sequence[FaultCase], baselines: Sequence[RunEnd]) -> None:
        self.rehearsals = tuple(baseline.run.entry for baseline in baselines)
        self._cases = {case.name.replace(" ", ":"): case for case in cases}
        self._hits = {each.run.rehearsal: tuple(self._of_rehearsal(each.run.entry, each.result)) for each in baselines}

    def _of_rehearsal(self, entry: RehearsalEntry, result: RehearsalResult) -> Iterator[Hit]:
        for fault in self._cases:
            for number in range(1, len(entry.steps) + 1):
                yield Hit(fault, number, "started")
                if _moves(result, number):
                    yield Hit(fault, number, "moving")

    def singles(self) -> Iterator[CampaignRun]:
        """Yield the runs with one fault, by rehearsal, fault and step."""
        for entry in self.rehearsals:
            for hit in self._hits[entry.name]:
                yield self._run(entry, (hit,))

    def pairs(self, count: int, seed: int) -> Iterator[CampaignRun]:
        """Yield so many different runs with two faults of different kind or target, drawn with a seed."""
        source = random.Random(seed)
        drawn: set[str] = set()
        choices = [(entry, hit) for entry in self.rehearsals for hit in self._hits[entry.name]]
        for _ in range(20 * count if choices else 0):
            if len(drawn) == count:
                return
            entry, first = source.choice(choices)
            second = source.choice(self._hits[entry.name])
            run = self._run(entry, tuple(sorted((first, second), key=lambda hit: (hit.step, str(hit)))))
            if first.fault != second.fault and run.identifier not in drawn:
                drawn.add(run.identifier)
                yield run

    def find(self, identifier: str) -> CampaignRun | None:
        """Return the run of an identifier; the rehearsal may be left out where there is only one."""
        for entry in self.rehearsals:
            known: Mapping[str, Hit] = {str(hit): hit for hit in self._hits[entry.name]}
            text = identifier.removeprefix(f"{entry.name}/")
            parts = text.split(_JOINED)
            if (text != identifier or len(self.rehearsals) == 1) and all(part in known for part in parts):
                return self._run(entry, tuple(known[part] for part in parts))
        return None

    def _run(self, entry: RehearsalEntry, hits: tuple[Hit, ...]) -> CampaignRun:
        cases = [self._cases[hit.fault] for hit in hits]
        met = [(case, hit.step, hit.when) for case, hit in zip(cases, hits, strict=True)]
        outcomes = [case.outcomes(entry.steps, step, when) for case, step, when in met]
        bounds = [case.within_s(entry.steps, step, when) for case, step, when in met]
        stated = [bound for bound in bounds if bound is not None]
        named = tuple(sorted(frozenset().union(*outcomes)))
        within_s = max(stated) if len(stated) == len(bounds) else None
        changed = {
            "name": f"{entry.name}/{_JOINED.join(str(hit) for hit in hits)}",
            "faults": tuple(case.at(step, when) for case, step, when in met),
            "expect": named[0],
            "within_s": within_s,
        }
        return CampaignRun(entry.name, hits, entry.model_copy(update=changed), named, within_s)


def _moves(result: RehearsalResult, step: int) -> bool:
    """Tell whether a joint is driven in a step of a rehearsal that nothing disturbs."""
    return any(point.step is PacketStep.DRIVEN for point in result.attempts[step - 1].trace)
