"""Executes a campaign, here or in worker processes; what comes out does not depend on how many there are."""

from __future__ import annotations

import hashlib
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess

from cellc.contract.rehearsals import RehearsalEntry
from cellc.description.packages import package_path, use_packages
from cellc.limits import Limits, limits, use
from cellc.mock.campaign.limits import LimitsReport, check_limits, merge
from cellc.mock.campaign.plan import CampaignPlan, CampaignRun, RunEnd
from cellc.mock.cell import MockCell, cell_of
from cellc.mock.control.journal import CommandJournal, CommandSamples, Interruption
from cellc.mock.errors import MockError
from cellc.mock.faults.cases import FaultCase
from cellc.mock.folder import GeneratedFolder
from cellc.mock.plant import Plant
from cellc.mock.result import RehearsalResult, RunFailure, to_json_lines
from cellc.signals import deaf_children, start_deaf_tracker


def execute(cell: MockCell, run: CampaignRun, seed: int) -> RunEnd:
    """Execute a run; the same cell, run and seed give the same end to the last bit.

    Raises:
        MockError: a fault names what the contract does not have.
    """
    journals: list[CommandJournal] = []

    def watch(plant: Plant) -> None:
        for server in plant.control.servers():
            server.journal.listening = True
            journals.append(server.journal)

    try:
        result = cell.rehearse(run.entry, seed=seed, watch=watch)
    except MockError:
        raise
    except Exception as bug:  # a run that breaks the mock must not hide the runs after it
        return RunEnd(run, _crashed(run), LimitsReport(), "", f"{type(bug).__name__}: {bug}")
    taken = [journal.take() for journal in journals]
    samples = [each for found, _ in taken for each in found]
    interruptions = [each for _, found in taken for each in found]
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


Numbered = tuple[int, RunEnd]


@dataclass(frozen=True, slots=True)
class Assignment:
    """What every worker knows before the first run."""

    folder: GeneratedFolder
    runs: tuple[CampaignRun, ...]
    seed: int
    limits: Limits
    packages: tuple[str, ...] = ()


def usable_cores() -> int:
    """Return how many cores this process may use."""
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run_here(cell: MockCell, assignment: Assignment) -> Iterator[Numbered]:
    """Execute the runs in this process, in order."""
    for number, run in enumerate(assignment.runs):
        yield number, execute(cell, run, assignment.seed)


def run_in_workers(assignment: Assignment, jobs: int) -> Iterator[Numbered]:
    """Execute the runs in so many processes; yields numbered ends as they come, every run once.

    Each worker is told its next run when it has ended one. Workers end when this generator does, however it does.

    Raises:
        MockError: a run cannot be executed, or a worker ended by itself.
    """
    start_deaf_tracker()
    workers: list[tuple[BaseProcess, Connection]] = []
    try:
        with deaf_children():
            workers += [_start() for _ in range(min(jobs, len(assignment.runs)))]
        for _, connection in workers:
            connection.send(assignment)
        yield from _deal([connection for _, connection in workers], assignment)
    finally:
        for process, connection in workers:
            connection.close()
            process.terminate()
        for process, _ in workers:
            process.join()


def _deal(connections: Sequence[Connection], assignment: Assignment) -> Iterator[Numbered]:
    busy: dict[Connection, int] = {}
    waiting = iter(range(len(assignment.runs)))
    for connection in connections:
        busy[connection] = next(waiting)
        connection.send(busy[connection])
    while busy:
        for ready in wait(list(busy)):
            assert isinstance(ready, Connection)  # nothing else is waited for
            number = busy.pop(ready)
            end = _received(ready, assignment.runs[number])
            following = next(waiting, None)
            if following is not None:
                busy[ready] = following
                ready.send(following)
            yield number, end


def _received(connection: Connection, run: CampaignRun) -> RunEnd:
    try:
        answer = connection.recv()
    except (EOFError, OSError):
        raise MockError("", f"the process that ran `{run.identifier}` ended by itself") from None
    if isinstance(answer, tuple):
        raise MockError(*answer)
    assert isinstance(answer, RunEnd)  # a worker sends one of the two
    return answer


def _start() -> tuple[BaseProcess, Connection]:
    """Start a worker in a fresh interpreter, so that it has nothing from this one on any platform."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=_work, args=(there,), daemon=True)
    process.start()
    there.close()
    return process, here


def _work(connection: Connection) -> None:
    """Execute the runs whose numbers arrive until the connection closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assignment: Assignment = connection.recv()
        use(assignment.limits)
        use_packages(assignment.packages)
        cell = cell_of(assignment.folder)
        while True:
            number = connection.recv()
            connection.send(execute(cell, assignment.runs[number], assignment.seed))
    except MockError as error:
        connection.send((error.file, error.reason))
    except (EOFError, OSError):
        pass  # nobody listens any more


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


def _is_plain(entry: RehearsalEntry) -> bool:
    """Tell whether a rehearsal has no fault of its own; how the real target comes up makes no step another one."""
    return not entry.faults and entry.bring_up == "mock"


def make_plan(cell: MockCell, cases: Sequence[FaultCase], seed: int) -> tuple[CampaignPlan, tuple[RunEnd, ...]]:
    """Run what is undisturbed, and plan faults for what succeeds; a rehearsal that fails by itself is told as failed.

    Raises:
        MockError: the cell cannot be executed, or has no rehearsal without faults.
    """
    undisturbed = [CampaignRun.undisturbed(entry) for entry in cell.entries if _is_plain(entry)]
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
    assignment = Assignment(cell.folder, tuple(runs), seed, limits(), package_path())
    arriving = run_here(cell, assignment) if jobs == 1 else run_in_workers(assignment, jobs)
    ends: dict[int, RunEnd] = {}
    failed = 0
    for number, end in arriving:
        ends[number] = end
        failed += not end.passed
        progress(len(ends), len(runs), failed)
    ordered = tuple(ends[number] for number in range(len(runs)))
    return Campaign(cell.contract.configuration_id, seed, baselines, ordered)
