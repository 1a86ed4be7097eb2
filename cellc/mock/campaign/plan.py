"""Which runs a campaign consists of: every fault at every step of every rehearsal without faults, and pairs of them."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence

from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock.campaign.run import CampaignRun, Hit, RunEnd
from cellc.mock.faults.case import FaultCase
from cellc.mock.record import PacketStep
from cellc.mock.result import RehearsalResult

_JOINED = "+"


class CampaignPlan:
    """The runs of the faults of a cell over the steps of its rehearsals.

    Args:
        cases: the faults that the cell can meet.
        baselines: ends of the rehearsals without faults; they tell which steps move anything.
    """

    def __init__(self, cases: Sequence[FaultCase], baselines: Sequence[RunEnd]) -> None:
        self.rehearsals = tuple(baseline.run.entry for baseline in baselines)
        self._cases = {_fault_name(case): case for case in cases}
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


def _fault_name(case: FaultCase) -> str:
    return case.name.replace(" ", ":")


def _moves(result: RehearsalResult, step: int) -> bool:
    """Tell whether a joint is driven in a step of a rehearsal that nothing disturbs."""
    return any(point.step is PacketStep.DRIVEN for point in result.attempts[step - 1].trace)
