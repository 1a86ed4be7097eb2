"""`cellc sweep` with the runs of it that `cellc replay` makes again, and `cellc gates`, which judges all evidence."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from time import perf_counter

from cellc.contract.compute.work import ComputeError
from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.limits import limits
from cellc.contract.printing import progress, remark, show, show_document
from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock.cell import MockCell, in_turn
from cellc.mock.command.campaign import conduct_all, executor, load_for_campaign, pace
from cellc.mock.command.ending import refusing
from cellc.mock.command.options import FolderOptions, GatesOptions, ReplayOptions, SweepOptions
from cellc.mock.command.rehearsals import keep_evidence, load_seeded
from cellc.mock.errors import MockError
from cellc.mock.gates.gate import Verdict, gate_lines, gates_as_data
from cellc.mock.gates.runs import judged_campaign, judged_rehearsals, rehearsed_with_masses
from cellc.mock.gates.sign import sign_gates
from cellc.mock.sweep.figures import interval
from cellc.mock.sweep.journal import Journal
from cellc.mock.sweep.names import SWEPT
from cellc.mock.sweep.runs import RunStore, SweepRun, SweepRuns
from cellc.mock.sweep.summary import run_lines, sweep_json, sweep_lines
from cellc.mock.sweep.sweep import (
    MOST_DIGITS,
    USUAL_CONFIDENCE,
    Sweep,
    execute,
    name_of,
    reality,
    sweep,
    uncertainty_of,
)

_EVIDENCE = 5
"""Failed runs whose evidence is kept; the others are made again by their number."""


@refusing
def run_sweep(options: SweepOptions) -> int:
    """Sweep rehearsals, and print how often they succeed.

    Returns:
        0 where every expected rate holds, 1 where one does not or is not certain, 2 where the folder or an option is
        unusable.
    """
    cell = load_seeded(options)
    sweeps = [sweep_entry(cell, entry, options) for entry in entries_to_sweep(cell, options)]
    failed = [(cell.entry(each.rehearsal), run) for each in sweeps for run in each.failed[:_EVIDENCE]]
    _keep_evidence(cell, failed, options, sweeps)
    notes = (*cell.notes, *_left_out(cell))
    if options.as_json:
        show_document(sweep_json(cell.contract, sweeps, notes))
    else:
        lines = (line for each in sweeps for line in sweep_lines(each, cell.contract, _replay(options, each)))
        show(*(f"note: {note}" for note in notes), *lines)
    return 0 if all(each.verdict or each.expected is None for each in sweeps) else 1


def _left_out(cell: MockCell) -> Iterator[str]:
    """Say in one line what is not drawn, where nothing has a mass."""
    drawn = {quantity.name for quantity in uncertainty_of(cell).quantities}
    stated = () if cell.folder.uncertainty is None else cell.folder.uncertainty.quantities
    if names := ", ".join(quantity.name for quantity in stated if quantity.name not in drawn):
        yield f"drawn with `--physics` alone: {names}"


@refusing
def run_gates(options: GatesOptions) -> int:
    """Run everything that is evidence, and print each gate with its lines.

    Returns:
        0 where no line failed, UNKNOWN ones among them; 1 where one did; 2 where the folder or an option is unusable.
    """
    cell, wanted = load_for_campaign(options), options.sweep
    entries = () if wanted is None else entries_to_sweep(cell, wanted)  # or it refuses, before the minutes of the rest
    results = [cell.run(name, seed=options.seed) for name in in_turn(cell, cell.rehearsals)]
    campaign = conduct_all(cell, options)
    sweeps = () if wanted is None else tuple(sweep_entry(cell, entry, wanted) for entry in entries)
    physics = rehearsed_with_masses(cell, Path(options.folder), options.seed)
    keep_evidence(cell, dict.fromkeys(cell.rehearsals), options, campaign, sweeps, physics)
    runs = (*judged_rehearsals(cell.entries, results), *judged_campaign(campaign))
    gates = sign_gates(cell.folder, runs, options.seed, sweeps, physics)
    if options.as_json:
        judged = {"gates": gates_as_data(gates), "notes": list(cell.notes)}
        show_document(json_document(judged))
    else:
        show(*(f"note: {note}" for note in cell.notes), *list(gate_lines(gates))[:-1])
    return 1 if any(gate.verdict is Verdict.FAILED for gate in gates) else 0


def entries_to_sweep(cell: MockCell, options: SweepOptions) -> Sequence[RehearsalEntry]:
    """Return the rehearsals that are meant; raise MockError where they cannot be swept as the options ask."""
    most = limits().sweep_runs
    if not 1 <= options.runs <= most:
        raise MockError("", f"the number of runs is {options.runs}; it must be 1 or greater, and at most {most}")
    _check_seed(options)
    entries = _meant(cell, options.rehearsals)
    if len(entries) > 1 and options.journal is not None:
        raise MockError("", "a journal is of one rehearsal; name it with --rehearsal")
    return entries


def _check_seed(options: FolderOptions) -> None:
    if options.seed >= 1 << 64:
        raise MockError("", f"the seed is {options.seed}; that of a sweep must be below 2^64")


def _meant(cell: MockCell, named: Sequence[str]) -> Sequence[RehearsalEntry]:
    """Return the rehearsals that are meant: those named, else those that must succeed often enough, else the first."""
    names = named or tuple(uncertainty_of(cell).expected) or cell.rehearsals[:1]
    if not names:
        raise MockError(cell.contract.files.rehearsals, "has no rehearsal to sweep")
    return [cell.entry(name) for name in dict.fromkeys(names)]


def sweep_entry(cell: MockCell, entry: RehearsalEntry, options: SweepOptions) -> Sweep:
    """Sweep one rehearsal, with its progress.

    Raises:
        MockError: a run cannot be executed, or no worker can be reached.
    """
    start, done = perf_counter(), 0
    failed = 0
    factory, who = executor(options.fan)
    with progress("sweep") as update, ExitStack() as stack:
        journal: Journal | None = None
        if options.journal is not None:
            journal = stack.enter_context(_journal(options.journal, cell, entry, options.seed))

        def keep(run: SweepRun) -> None:
            nonlocal done, failed
            done += 1
            failed += not run.passed
            if journal is not None:
                journal.keep(run)
            said = f"{done} of at most {options.runs}"
            update(pace(said, options.runs, done, failed, perf_counter() - start))

        ends = RunStore() if journal is None else journal.runs
        try:
            result = sweep(cell, entry, seed=options.seed, most=options.runs, factory=factory, ends=ends, keep=keep)
        except ComputeError as problem:
            raise MockError("", str(problem)) from None
    remark(f"{done} runs in {perf_counter() - start:.1f} s, {who}")
    return result


def _journal(path: str, cell: MockCell, entry: RehearsalEntry, seed: int) -> Journal:
    return Journal(Path(path), cell.contract, entry.name, seed, cell.folder.masses)


@refusing
def replay_swept(options: ReplayOptions) -> int:
    """Run some runs of a sweep alone; they end as they did in it, to the last bit."""
    _check_seed(options)
    cell = load_seeded(options)
    uncertainty = uncertainty_of(cell)
    entry = _meant(cell, () if options.rehearsal is None else (options.rehearsal,))[0]
    if options.journal is not None:
        _journal(options.journal, cell, entry, options.seed)  # or it refuses
    numbers = [_number(text) for text in dict.fromkeys(options.runs)]
    runs = [execute(cell, entry, uncertainty, options.seed, number) for number in numbers]
    _keep_evidence(cell, [(entry, run) for run in runs], options)
    if options.as_json:
        rate = interval(sum(run.passed for run in runs), len(runs), USUAL_CONFIDENCE)
        alone = Sweep(entry.name, options.seed, uncertainty, len(runs), SweepRuns.listed(runs), rate, None, None)
        show_document(sweep_json(cell.contract, (alone,), cell.notes))
    else:
        lines = (line for run in runs for line in run_lines(run, uncertainty, options.seed))
        show(*(f"note: {note}" for note in cell.notes), *lines)
    return 0 if all(run.passed for run in runs) else 1


def _number(text: str) -> int:
    number = text.removeprefix(SWEPT)
    if text == number or not (number.isascii() and number.isdigit()) or len(number) > MOST_DIGITS:
        raise MockError("", f"there is no run `{text}`; a run of a sweep is `{SWEPT}NUMBER`")
    return int(number)


def _replay(options: SweepOptions, of: Sweep) -> Callable[[int], str]:
    return lambda number: options.replayed_by(f"{SWEPT}{number}", of.rehearsal)


def _keep_evidence(
    cell: MockCell,
    runs: Sequence[tuple[RehearsalEntry, SweepRun]],
    options: FolderOptions,
    sweeps: Sequence[Sweep] = (),
) -> None:
    """Make the runs rehearsals of the cell and run them once more, where evidence is asked for."""
    uncertainty = uncertainty_of(cell)
    added = {name_of(entry.name, run): (entry, run) for entry, run in runs}
    entries = tuple(entry.model_copy(update={"name": name}) for name, (entry, _) in added.items())
    folder = replace(cell.folder, rehearsals=(*cell.folder.rehearsals, *entries))
    widened = cell.with_realities(
        folder, {name: reality(uncertainty, options.seed, run.number) for name, (_, run) in added.items()}
    )
    keep_evidence(widened, {name: run for name, (_, run) in added.items()}, options, sweeps=sweeps)
