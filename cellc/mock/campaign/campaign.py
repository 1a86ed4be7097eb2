"""Executes a campaign, here or in worker processes; what comes out does not depend on how many there are."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence

from cellc.contract.compute.work import ExecutorFactory, Work, in_order, stream
from cellc.contract.frozen import dataclass
from cellc.contract.limits import Limits, limits, use
from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock.campaign.limits import LimitsReport, check_limits, merge
from cellc.mock.campaign.plan import CampaignPlan, CampaignRun, RunEnd
from cellc.mock.cell import MockCell, Watch, cell_of
from cellc.mock.control.journal import CommandJournal, CommandSamples, Interruption
from cellc.mock.errors import MockError
from cellc.mock.faults.cases import FaultCase
from cellc.mock.folder import GeneratedFolder
from cellc.mock.plant import Plant
from cellc.mock.result import RehearsalResult, RunFailure, to_json_lines
from cellc.robot.description.packages import package_path, use_packages

Rehearse = Callable[[MockCell, RehearsalEntry, int, Watch], RehearsalResult]
"""Runs a rehearsal with a seed in another way than all of it on the mock; it is sent to workers as it is."""


def execute(cell: MockCell, run: CampaignRun, seed: int, rehearse: Rehearse | None = None) -> RunEnd:
    """Execute a run; the same cell, run and seed give the same end to the last bit.

    Args:
        rehearse: how, where some nodes are not played.

    Raises:
        MockError: a fault names what the contract does not have.
    """
    journals: list[CommandJournal] = []

    def watch(plant: Plant) -> None:
        journals.clear()
        for server in plant.control.servers():
            server.journal.listening = True
            journals.append(server.journal)

    try:
        if rehearse is None:
            result = cell.rehearse(run.entry, seed=seed, watch=watch, from_off=False)
        else:
            result = rehearse(cell, run.entry, seed, watch)
    except MockError:
        raise
    except Exception as bug:  # a run that breaks the mock must not hide the runs after it
        return RunEnd(run, _crashed(run), LimitsReport(), "", f"{type(bug).__name__}: {bug}")
    taken = [journal.take() for journal in journals]
    samples = [each for part, _ in taken for each in part]
    interruptions = [each for _, part in taken for each in part]
    limits = check_limits(cell.contract, samples, interruptions)
    return RunEnd(run, result, limits, _digest(result, samples, interruptions))


def _crashed(run: CampaignRun) -> RehearsalResult:
    return RehearsalResult(
        name=run.identifier,
        outcome=RunFailure.CRASHED,
        expected=run.entry.expect,
        sim_time_s=0.0,
        response_s=None,
        within_s=run.within_s,
        attempts=(),
        bringup=(),
        findings=(),
    )


def _digest(result: RehearsalResult, samples: Sequence[CommandSamples], interruptions: Sequence[Interruption]) -> str:
    digest = hashlib.sha256(to_json_lines(result.attempts).encode())
    for each in samples:
        digest.update("\0".join((each.controller, *each.interfaces)).encode())
        digest.update(each.stamps_ns.tobytes() + each.values.tobytes())
    digest.update(repr((interruptions, result.outcome.value, result.response_s, result.findings)).encode())
    return digest.hexdigest()[:16]


@dataclass(frozen=True, slots=True)
class Assignment:
    """What every worker knows before the first run.

    Attributes:
        unseen: links whose meshes are not here; elsewhere others may be missing. None for workers of this computer.
        masses: what computes with masses here; empty where nothing has any.
        rehearse: how, where some nodes are not played.
    """

    folder: GeneratedFolder
    seed: int
    limits: Limits
    packages: tuple[str, ...]
    unseen: tuple[str, ...] | None
    masses: str = ""
    rehearse: Rehearse | None = None

    @classmethod
    def of(cls, cell: MockCell, seed: int, rehearse: Rehearse | None = None) -> Assignment:
        """Return the assignment for workers of a cell that was loaded here."""
        return cls(cell.folder, seed, limits(), package_path(), cell.unseen, cell.folder.masses, rehearse)

    def cell(self) -> MockCell:
        """Load the cell in a worker.

        Raises:
            MockError: its parts do not fit together, or it is another cell here.
        """
        use(self.limits)
        use_packages(self.packages)
        cell = cell_of(self.folder)
        if self.masses != cell.folder.masses:
            raise MockError("", f"a worker has {cell.folder.masses}, this computer has {self.masses}")
        if self.unseen is not None and (apart := sorted({*cell.unseen} ^ {*self.unseen})):
            raise MockError("", f"a worker has other meshes than this computer, those of `{apart[0]}` first")
        return cell


def _begin(assignment: Assignment) -> Callable[[CampaignRun], RunEnd]:
    cell = assignment.cell()
    return lambda run: execute(cell, run, assignment.seed, assignment.rehearse)


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


def run_all(
    cell: MockCell,
    runs: Sequence[CampaignRun],
    seed: int,
    factory: ExecutorFactory | None,
    rehearse: Rehearse | None = None,
) -> Iterator[tuple[int, RunEnd]]:
    """Yield the ends of runs with their numbers, as they come."""
    if factory is None:
        return ((number, execute(cell, run, seed, rehearse)) for number, run in enumerate(runs))
    return stream(Work(_begin, Assignment.of(cell, seed, rehearse), _identifier), runs, factory)


def _identifier(run: CampaignRun) -> str:
    return run.identifier


def make_plan(
    cell: MockCell,
    cases: Sequence[FaultCase],
    seed: int,
    rehearse: Rehearse | None = None,
    factory: ExecutorFactory | None = None,
) -> tuple[CampaignPlan, tuple[RunEnd, ...]]:
    """Run what is undisturbed, and plan faults for what succeeds; a rehearsal that fails by itself is reported as
    failed.

    Raises:
        MockError: the cell cannot be executed, or has no rehearsal without faults.
    """
    undisturbed = [CampaignRun.undisturbed(entry) for entry in cell.entries if entry.is_plain]
    if not undisturbed:
        raise MockError(cell.contract.files.rehearsals, "has no rehearsal without faults to run a campaign over")
    baselines = tuple(in_order(run_all(cell, undisturbed, seed, factory, rehearse)))
    return CampaignPlan(cases, [baseline for baseline in baselines if baseline.named]), baselines


def conduct(
    cell: MockCell,
    runs: Sequence[CampaignRun],
    baselines: tuple[RunEnd, ...],
    *,
    seed: int,
    factory: ExecutorFactory | None,
    progress: Progress,
    rehearse: Rehearse | None = None,
) -> Campaign:
    """Execute runs in this process or by an executor, with the same result.

    Raises:
        ComputeError: no worker can execute a run.
        MockError: a run cannot be executed.
    """
    ends: dict[int, RunEnd] = {}
    failed = 0
    for number, end in run_all(cell, runs, seed, factory, rehearse):
        ends[number] = end
        failed += not end.passed
        progress(len(ends), len(runs), failed)
    ordered = tuple(ends[number] for number in range(len(runs)))
    return Campaign(cell.contract.configuration_id, seed, baselines, ordered)
