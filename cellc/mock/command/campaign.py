"""`cellc campaign`, and the runs of it that `cellc replay` makes again: plan, run, report, and print the result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice
from pathlib import Path
from time import perf_counter

from cellc.contract.compute.fan import Fan
from cellc.contract.compute.processes import usable_cores
from cellc.contract.compute.work import ComputeError, ExecutorFactory
from cellc.contract.diagnostics import nearest
from cellc.contract.diagnostics.wording import time_left
from cellc.contract.limits import limits, option
from cellc.contract.printing import columns, progress, remark, show, show_document
from cellc.mock.campaign.campaign import Campaign, Rehearse, conduct, make_plan
from cellc.mock.campaign.plan import CampaignPlan, CampaignRun
from cellc.mock.campaign.summary import campaign_json, campaign_lines, end_lines
from cellc.mock.cell import MockCell, cell_of
from cellc.mock.command.ending import refusing
from cellc.mock.command.options import CampaignOptions, ReplayOptions
from cellc.mock.command.records import refuse_foreign, write_records
from cellc.mock.command.rehearsals import keep_evidence, load_seeded
from cellc.mock.errors import MockError
from cellc.mock.faults.registry import possible_faults
from cellc.mock.ros.asked import AmongNodes

Choice = Callable[[CampaignPlan], Sequence[CampaignRun]]


@refusing
def run_campaign(options: CampaignOptions) -> int:
    """Run every fault at every step, and pairs; print the matrix.

    Returns:
        0 where every run ended in a named outcome within bounds and limits, 1 where one did not, 2 where the folder or
        an option is unusable.
    """
    cell = load_for_campaign(options)
    campaign = conduct_all(cell, options)
    keep_evidence(cell, dict.fromkeys(cell.rehearsals), options, campaign)
    if options.as_json:
        show_document(campaign_json(campaign, cell.notes, options.replayed_by))
    else:
        show(*(f"note: {note}" for note in cell.notes), *campaign_lines(campaign, options.replayed_by, columns(0)))
    return 0 if campaign.passed else 1


@refusing
def replay_runs(options: ReplayOptions) -> int:
    """Run some runs of a campaign alone; they end as they did in it, to the last bit."""

    def named_runs(plan: CampaignPlan) -> Sequence[CampaignRun]:
        return [_found(cell, plan, identifier) for identifier in dict.fromkeys(options.runs)]

    cell = load_seeded(options)
    campaign = _conduct(cell, named_runs, replace(options, fan=Fan(jobs=1)))
    ended = tuple(
        end.run.entry.model_copy(update={"expect": end.result.outcome} if end.named else {}) for end in campaign.ends
    )
    widened = cell_of(replace(cell.folder, rehearsals=(*cell.folder.rehearsals, *ended)))
    keep_evidence(widened, dict.fromkeys(entry.name for entry in ended), options)
    if options.as_json:
        show_document(campaign_json(replace(campaign, baselines=()), cell.notes, options.replayed_by))
    else:
        ends = ((end, options.replayed_by(end.run.identifier)) for end in campaign.ends)
        lines = (line for end, replay in ends for line in end_lines(end, replay))
        show(*(f"note: {note}" for note in cell.notes), *lines)
    return 0 if all(end.passed for end in campaign.ends) else 1


@refusing
def list_runs(options: CampaignOptions) -> int:
    """Print the identifiers of the runs of a campaign; only the rehearsals without faults are run."""
    cell = load_for_campaign(options)
    plan, _ = make_plan(cell, possible_faults(cell.contract), options.seed)
    show(*(run.identifier for run in _seen(cell, _all_runs(plan, options), options.among)))
    return 0


def _all_runs(plan: CampaignPlan, options: CampaignOptions) -> Sequence[CampaignRun]:
    most = limits().campaign_runs
    runs = (*islice(plan.singles(), most + 1), *plan.pairs(options.pairs, options.seed))
    if len(runs) > most:
        raise MockError("", f"the campaign has more than {most} runs; {option('campaign-runs')}")
    return runs


def load_for_campaign(options: CampaignOptions) -> MockCell:
    """Load a folder; raise MockError where it or an option cannot be used."""
    most = limits().campaign_runs
    if not 0 <= options.pairs <= most:
        problem = f"the number of pairs is {options.pairs}; it must be 0 or greater, and at most {most}"
        raise MockError("", f"{problem}; {option('campaign-runs')}")
    return load_seeded(options)


def conduct_all(cell: MockCell, options: CampaignOptions) -> Campaign:
    """Conduct the whole campaign; raise MockError where a run cannot be executed."""
    return _conduct(cell, lambda plan: _all_runs(plan, options), options)


def _conduct(cell: MockCell, choose: Choice, options: CampaignOptions | ReplayOptions) -> Campaign:
    if options.records is not None:
        refuse_foreign(Path(options.records))
    start = perf_counter()
    rehearse = None if options.among is None else _among(options.among)
    factory, who = executor(options.fan) if options.among is None else _executor_among(options.among, options.fan)
    plan, baselines = make_plan(
        cell, possible_faults(cell.contract), options.seed, rehearse, None if rehearse is None else factory
    )
    runs = _seen(cell, choose(plan), options.among)
    with progress("campaign") as update:

        def report(done: int, total: int, failed: int) -> None:
            update(pace(f"{done} of {total}", total, done, failed, perf_counter() - start))

        try:
            campaign = conduct(
                cell, runs, baselines, seed=options.seed, factory=factory, progress=report, rehearse=rehearse
            )
        except ComputeError as problem:
            raise MockError("", str(problem)) from None
    if options.records is not None:
        attempts = (record for end in campaign.all_ends for record in end.result.attempts)
        write_records(Path(options.records), attempts)
    remark(f"{len(runs)} runs in {perf_counter() - start:.1f} s, {who}")
    return campaign


def _among(asked: AmongNodes) -> Rehearse:
    """Return how a rehearsal is run around nodes that are not played."""
    from cellc.mock.ros.session import rehearse_on_own_domain

    return partial(rehearse_on_own_domain, asked)


def _executor_among(asked: AmongNodes, fan: Fan) -> tuple[ExecutorFactory | None, str]:
    """Return who executes runs around nodes that are not played, and the domains that they use.

    Raises:
        MockError: the processes cannot have a domain and nodes of their own.
    """
    jobs = fan.jobs or 1
    if jobs == 1:
        return None, "one after the other"
    if not asked.launch:
        raise MockError("", "--jobs with --ros needs --launch: each process starts nodes on a domain of its own")
    last = asked.domain - jobs + 1
    if last < 0:
        raise MockError("", f"--jobs {jobs} needs as many domains; --domain must be {jobs - 1} or greater")
    return fan.factory(jobs, remark), f"{jobs} processes on domains {last} to {asked.domain}"


def _seen(cell: MockCell, runs: Sequence[CampaignRun], asked: AmongNodes | None) -> Sequence[CampaignRun]:
    """Return the runs with a fault that the nodes under test can see, with time for them to react; else all runs."""
    if asked is None:
        return runs
    from cellc.mock.ros.session import concerns
    from cellc.mock.ros.task import REACTION_S

    contract, without = cell.contract, asked.without
    seen = [run for run in runs if any(concerns(contract, without, fault) for fault in run.entry.faults)]
    return [run if run.within_s is None else run.within(run.within_s + REACTION_S) for run in seen]


def _found(cell: MockCell, plan: CampaignPlan, identifier: str) -> CampaignRun:
    run = plan.find(identifier)
    if run is not None:
        return run
    name = identifier.partition("/")[0]
    plain = {entry.name for entry in cell.entries if entry.is_plain}
    if name in plain - {entry.name for entry in plan.rehearsals}:
        raise MockError("", f"`{name}` does not end as it must without a fault, so that it has no runs with one")
    known = [run.identifier for run in plan.singles()]
    close = ", ".join(f"`{name}`" for name in nearest(identifier, known))
    hint = f"; the nearest are {close}" if close else "; `cellc campaign --list` prints all"
    raise MockError("", f"there is no run `{identifier}`{hint}")


def pace(run: str, total: int, done: int, failed: int, seconds: float) -> str:
    """Return how far runs have come, how fast they are, and how long the rest takes.

    Args:
        run: the number of the present one, and how many there are at most, in words.
        done: in ``seconds``.
    """
    rate = done / max(seconds, 1e-3)
    return f"run {run}, {failed} failed, {rate:.0f} a second{time_left(done, total, seconds)}"


def executor(fan: Fan) -> tuple[ExecutorFactory | None, str]:
    """Return who executes runs, None for this process alone, and how many they are in words."""
    usual = usable_cores()
    who = f"{fan.jobs or usual} processes" if fan.cluster is None else f"workers of {fan.cluster}"
    return fan.factory(usual, remark), who
