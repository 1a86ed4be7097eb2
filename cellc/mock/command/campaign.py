"""The commands behind `--campaign`, `--list` and `--replay`: plan, run, report, and print the result."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice
from pathlib import Path
from time import perf_counter

from cellc.contract.compute.work import ComputeError
from cellc.contract.diagnostics import nearest
from cellc.contract.limits import limits, option
from cellc.contract.printing import progress, refuse, remark, show, show_document, time_left
from cellc.mock.campaign.campaign import Campaign, conduct, make_plan
from cellc.mock.campaign.plan import CampaignPlan, CampaignRun
from cellc.mock.campaign.summary import campaign_json, campaign_lines, end_lines
from cellc.mock.cell import MockCell, cell_of, load
from cellc.mock.command.options import MockOptions, refuse_foreign, write_records
from cellc.mock.command.rehearsals import begin_evidence
from cellc.mock.errors import MockError
from cellc.mock.faults.registry import possible_faults
from cellc.mock.sweep.sweep import Sweep

Choice = Callable[[CampaignPlan], Sequence[CampaignRun]]


def run_campaign(options: MockOptions) -> int:
    """Run every fault at every step, and pairs; print the matrix.

    Returns:
        0 where every run ended in a named outcome within bounds and limits, 1 where one did not, 2 where the folder or
        an option is unusable.
    """

    try:
        cell = load_checked(options)
        campaign = conduct_all(cell, options)
        keep_evidence_of(cell, campaign, options)
    except MockError as stop:
        return stopped(stop)
    replay = partial(_replay_command, options)
    if options.as_json:
        show_document(campaign_json(campaign, cell.notes, replay))
    else:
        show(*(f"note: {note}" for note in cell.notes), *campaign_lines(campaign, replay))
    return 0 if campaign.passed else 1


def replay_runs(options: MockOptions) -> int:
    """Run some runs of a campaign alone; they end as they did in it, to the last bit."""

    def named_runs(plan: CampaignPlan) -> Sequence[CampaignRun]:
        return [_found(plan, identifier) for identifier in dict.fromkeys(options.replay)]

    try:
        cell = load_checked(options)
        campaign = _conduct(cell, named_runs, replace(options, jobs=1, cluster=None))
        if options.evidence is not None:
            _keep_evidence(cell, campaign, Path(options.evidence))
    except MockError as stop:
        return stopped(stop)
    replay = partial(_replay_command, options)
    if options.as_json:
        show_document(campaign_json(replace(campaign, baselines=()), cell.notes, replay))
    else:
        lines = (line for end in campaign.ends for line in end_lines(end, replay(end.run.identifier)))
        show(*(f"note: {note}" for note in cell.notes), *lines)
    return 0 if all(end.passed for end in campaign.ends) else 1


def keep_evidence_of(cell: MockCell, campaign: Campaign, options: MockOptions, sweeps: Sequence[Sweep] = ()) -> None:
    """Write bags of the declared rehearsals and a report over them and the campaign, where evidence is asked for."""
    if options.evidence is None:
        return
    with begin_evidence(cell, Path(options.evidence), cell.rehearsals, campaign.seed) as collector:
        for name in cell.rehearsals:
            collector.run(name)
        collector.settle(campaign, sweeps)


def _keep_evidence(cell: MockCell, campaign: Campaign, folder: Path) -> None:
    """Run the runs once more as rehearsals of the cell, and write what they leave."""
    known = cell.folder.rehearsals
    added = tuple(
        end.run.entry.model_copy(update={"expect": end.result.outcome} if end.named else {}) for end in campaign.ends
    )
    widened = cell_of(replace(cell.folder, rehearsals=(*known, *added)))
    names = [entry.name for entry in added]
    with begin_evidence(widened, folder, names, campaign.seed) as collector:
        for name in names:
            collector.run(name)
        collector.settle()


def list_runs(options: MockOptions) -> int:
    """Print the identifiers of the runs of a campaign; only the rehearsals without faults are run."""
    try:
        cell = load_checked(options)
        plan, _ = make_plan(cell, possible_faults(cell.contract), options.seed)
        runs = _all_runs(plan, options)
    except MockError as stop:
        return stopped(stop)
    show(*(run.identifier for run in runs))
    return 0


def _all_runs(plan: CampaignPlan, options: MockOptions) -> Sequence[CampaignRun]:
    most = limits().campaign_runs
    runs = (*islice(plan.singles(), most + 1), *plan.pairs(options.pairs, options.seed))
    if len(runs) > most:
        raise MockError("", f"the campaign has more than {most} runs; {option('campaign-runs')}")
    return runs


def load_checked(options: MockOptions) -> MockCell:
    """Load a folder, and check the numbers of the options; raise MockError where either cannot be used."""
    for name, value, least in (
        ("seed", options.seed, 0),
        ("number of pairs", options.pairs, 0),
        ("number of runs", options.sweep, 0),
        ("number of jobs", options.jobs, 1),
    ):
        if value is not None and value < least:
            raise MockError("", f"the {name} is {value}; it must be {least} or greater")
    if options.swept and options.seed >= 1 << 64:
        raise MockError("", f"the seed is {options.seed}; that of a sweep must be below 2^64")
    most = limits().campaign_runs
    for name, value in (("number of pairs", options.pairs), ("number of jobs", options.jobs)):
        if value is not None and value > most:
            raise MockError("", f"the {name} is {value}; it must be at most {most}; {option('campaign-runs')}")
    if options.sweep > limits().sweep_runs:
        raise MockError(
            "",
            f"the number of runs is {options.sweep}; it must be at most {limits().sweep_runs}; {option('sweep-runs')}",
        )
    return load(Path(options.folder), edited=options.edited)


def conduct_all(cell: MockCell, options: MockOptions) -> Campaign:
    """Conduct the whole campaign; raise MockError where a run cannot be executed."""
    return _conduct(cell, lambda plan: _all_runs(plan, options), options)


def _conduct(cell: MockCell, choose: Choice, options: MockOptions) -> Campaign:
    if options.records is not None:
        refuse_foreign(Path(options.records))
    begun = perf_counter()
    plan, baselines = make_plan(cell, possible_faults(cell.contract), options.seed)
    runs = choose(plan)
    factory, who = options.executor()
    with progress("campaign") as update:

        def told(done: int, total: int, failed: int) -> None:
            update(pace(f"{done} of {total}", total, done, failed, perf_counter() - begun))

        try:
            campaign = conduct(cell, runs, baselines, seed=options.seed, factory=factory, progress=told)
        except ComputeError as problem:
            raise MockError("", str(problem)) from None
    if options.records is not None:
        attempts = (record for end in campaign.all_ends for record in end.result.attempts)
        write_records(Path(options.records), attempts)
    remark(f"{len(runs)} runs in {perf_counter() - begun:.1f} s, {who}")
    return campaign


def _found(plan: CampaignPlan, identifier: str) -> CampaignRun:
    run = plan.find(identifier)
    if run is not None:
        return run
    known = [run.identifier for run in plan.singles()]
    close = ", ".join(f"`{name}`" for name in nearest(identifier, known))
    hint = f"; the nearest are {close}" if close else "; --list prints all"
    raise MockError("", f"there is no run `{identifier}`{hint}")


def _replay_command(options: MockOptions, identifier: str) -> str:
    seed = f" --seed {options.seed}" if options.seed else ""
    seed += " --edited" if options.edited else ""
    return f"{options.program} {shlex.quote(options.folder)} --replay {shlex.quote(identifier)}{seed}"


def pace(run: str, total: int, done: int, failed: int, seconds: float) -> str:
    """Return how far runs have come, how fast they are, and how long the rest takes.

    Args:
        run: the number of the present one, and how many there are at most, in words.
        done: in ``seconds``.
    """
    rate = done / max(seconds, 1e-3)
    return f"run {run}, {failed} failed, {rate:.0f} a second{time_left(done, total, seconds)}"


def stopped(stop: MockError) -> int:
    """Say why there is no result of it; return the exit code."""
    refuse(str(stop))
    return 2
