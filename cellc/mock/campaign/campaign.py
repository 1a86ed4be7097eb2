"""A whole campaign: the rehearsals undisturbed, then every run of the plan, and what came of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from cellc.mock.campaign.execute import Assignment, execute, run_here, run_in_workers
from cellc.mock.campaign.limits import LimitsReport, merge
from cellc.mock.campaign.plan import CampaignPlan, CampaignRun, RunEnd
from cellc.mock.cell import MockCell
from cellc.mock.errors import MockError
from cellc.mock.faults.case import FaultCase

Progress = Callable[[int, int, int], None]
"""Called with the number of runs that have ended, of all runs, and of those that failed."""


@dataclass(frozen=True, slots=True)
class Campaign:
    """What a campaign found, in the order of its plan.

    Attributes:
        baselines: ends of the rehearsals without faults.
        ends: ends of the runs with faults.
    """

    configuration_id: str
    seed: int
    baselines: tuple[RunEnd, ...]
    ends: tuple[RunEnd, ...]

    @property
    def all_ends(self) -> tuple[RunEnd, ...]:
        """All runs, the undisturbed ones first."""
        return (*self.baselines, *self.ends)

    @property
    def failed(self) -> tuple[RunEnd, ...]:
        """The runs that did not end as they must."""
        return tuple(end for end in self.all_ends if not end.passed)

    @property
    def limits(self) -> LimitsReport:
        """Limits over all runs."""
        return merge(end.limits for end in self.all_ends)

    @property
    def passed(self) -> bool:
        """Tell whether there was something to run and all of it ended as it must."""
        return bool(self.ends) and not self.failed


def make_plan(cell: MockCell, cases: Sequence[FaultCase], seed: int) -> tuple[CampaignPlan, tuple[RunEnd, ...]]:
    """Run what is undisturbed, and plan faults for what succeeds; a rehearsal that fails by itself is told as failed.

    Raises:
        MockError: the cell cannot be executed, or has no rehearsal without faults.
    """
    undisturbed = [CampaignRun.undisturbed(entry) for entry in cell.entries if not entry.faults]
    if not undisturbed:
        raise MockError(cell.contract.files.rehearsals, "has no rehearsal without faults to run a campaign over")
    baselines = tuple(execute(cell, run, seed) for run in undisturbed)
    return CampaignPlan(cases, [baseline for baseline in baselines if baseline.named]), baselines


def conduct(
    cell: MockCell,
    runs: Sequence[CampaignRun],
    baselines: tuple[RunEnd, ...],
    *,
    seed: int,
    jobs: int,
    progress: Progress,
) -> Campaign:
    """Execute runs in ``jobs`` processes; the campaign is the same for any number of them.

    Raises:
        MockError: a run cannot be executed.
    """
    assignment = Assignment(cell.folder, tuple(runs), seed)
    arriving = run_here(cell, assignment) if jobs == 1 else run_in_workers(assignment, jobs)
    ends: dict[int, RunEnd] = {}
    failed = 0
    for number, end in arriving:
        ends[number] = end
        failed += not end.passed
        progress(len(ends), len(runs), failed)
    ordered = tuple(ends[number] for number in range(len(runs)))
    return Campaign(cell.contract.configuration_id, seed, baselines, ordered)
