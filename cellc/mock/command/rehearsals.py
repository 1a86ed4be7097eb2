"""`cellc mock FOLDER`: run rehearsals, print results as lines or JSON, and begin their evidence."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.extras import FILM, LIVE, gate
from cellc.contract.frozen import dataclass
from cellc.contract.printing import progress, show, show_document
from cellc.mock.cell import MockCell, in_turn, load
from cellc.mock.command.ending import refusing
from cellc.mock.command.options import FolderOptions, Live, RehearsalOptions
from cellc.mock.command.records import refuse_foreign, write_records
from cellc.mock.errors import MockError
from cellc.mock.gates import NO_PHYSICS, PhysicsRuns
from cellc.mock.result import RehearsalResult
from cellc.mock.ros.asked import AmongNodes

if TYPE_CHECKING:
    from cellc.mock.campaign.campaign import Campaign
    from cellc.mock.command.evidence import EvidenceCollector
    from cellc.mock.command.live import LiveView
    from cellc.mock.sweep.runs import SweepRun
    from cellc.mock.sweep.sweep import Sweep


_CONTACTS = 3
"""That are printed of a rehearsal, the hardest."""


@dataclass(frozen=True, slots=True)
class TimedResult:
    """A result with the time that the host needed, which is in no record and no evidence."""

    result: RehearsalResult
    wall_time_s: float


def to_summary_json(configuration_id: str, timed: Sequence[TimedResult], notes: Sequence[str]) -> str:
    """Return the machine-readable summary of a run."""
    rehearsals = [
        {
            "name": each.result.name,
            "outcome": each.result.outcome,
            "expected": each.result.expected,
            "passed": each.result.passed,
            "sim_time_s": each.result.sim_time_s,
            "wall_time_s": round(each.wall_time_s, 4),
            "response_s": each.result.response_s,
            "within_s": each.result.within_s,
            "reason": each.result.reason,
            "edited": each.result.edited,
            "violations": list(each.result.violations),
            "findings": list(each.result.findings),
            "contacts": [asdict(contact) for contact in each.result.contacts],
        }
        for each in timed
    ]
    summary = {"configuration_id": configuration_id, "rehearsals": rehearsals, "notes": list(notes)}
    return json_document(summary)


def to_lines(timed: Sequence[TimedResult], notes: Sequence[str]) -> Iterator[str]:
    """Yield the summary for people: one line a rehearsal, the reason below where it is not a plain success."""
    for note in notes:
        yield f"note: {note}"
    if not timed:
        yield "note: no rehearsal is declared; nothing was run, and nothing is shown"
    for each in timed:
        result = each.result
        verdict = "passed" if result.passed else "FAILED"
        speed = result.sim_time_s / each.wall_time_s if each.wall_time_s > 0.0 else 0.0
        yield (
            f"{verdict}  {result.title}: {result.outcome} (expected {result.expected}), "
            f"{result.sim_time_s:.2f} s simulated in {each.wall_time_s:.2f} s ({speed:.0f} x real time)"
        )
        if result.within_s is not None and result.response_s is not None:
            yield f"        bound: {result.response_s * 1e3:.0f} ms of {result.within_s * 1e3:.0f} ms"
        if result.reason:
            yield f"        reason: {result.reason}"
        for violation in result.violations:
            yield f"        against the contract: {violation}"
        for finding in result.findings:
            yield f"        finding: {finding}"
        for contact in result.contacts[:_CONTACTS]:
            yield f"        contact: {contact}"
        if (more := len(result.contacts) - _CONTACTS) > 0:
            yield f"        contact: {more} more, with less force; `--evidence` has all"


@refusing
def run_rehearsals(options: RehearsalOptions) -> int:
    """Run rehearsals of a folder and print the results.

    Returns:
        0: every rehearsal passed; 1: one did not, or the folder has none; 2: the folder or a name is unusable.
    """
    if options.against:
        from cellc.mock.command.against import compare

        return compare(options)
    if options.records is not None:
        refuse_foreign(Path(options.records))  # before the minutes that a run may take
    cell = load_seeded(options)
    names = tuple(dict.fromkeys(options.rehearsals)) or cell.rehearsals
    if options.among is not None:
        timed, notes = _among(cell, names, options, options.among)
        _tell(cell, timed, options, notes)
    elif options.live is None:
        timed = _run(cell, names, options)
        _tell(cell, timed, options)
    else:
        with begin_live(options.live) as view:
            timed = _timed(cell, names, lambda name: view.run(cell, name, options.seed), lambda: view.executed_s)
            _tell(cell, timed, options)
            view.stay()
    return 0 if timed and all(each.result.passed for each in timed) else 1


def _among(
    cell: MockCell, names: Sequence[str], options: RehearsalOptions, asked: AmongNodes
) -> tuple[list[TimedResult], list[str]]:
    """Run rehearsals around nodes that are not played; also return what of them depends on the host."""
    from cellc.mock.ros.session import rehearse_among

    notes: list[str] = []

    def run(name: str) -> RehearsalResult:
        judged = rehearse_among(cell, cell.entry(name), options.seed, asked)
        notes.extend(f"{name}: {note}" for note in judged.notes)
        return judged.result

    return _timed(cell, names, run), notes


def _tell(cell: MockCell, timed: Sequence[TimedResult], options: RehearsalOptions, more: Sequence[str] = ()) -> None:
    notes = (*cell.notes, *more)
    if options.records is not None:
        records = (record for each in timed for record in each.result.attempts)
        write_records(Path(options.records), records)
    if options.as_json:
        show_document(to_summary_json(cell.contract.configuration_id, timed, notes))
    else:
        show(*to_lines(timed, notes))


def load_seeded(options: FolderOptions) -> MockCell:
    """Load a folder; raise MockError where it or the seed cannot be used."""
    if options.seed < 0:
        raise MockError("", f"the seed is {options.seed}; it must be 0 or greater")
    return load(Path(options.folder), edited=options.edited, stage=options.stage, physics=options.physics)


def _run(cell: MockCell, names: Sequence[str], options: RehearsalOptions) -> list[TimedResult]:
    if options.film is not None:
        return _timed(cell, names, _filming(options.film, cell, names, options.seed))
    if options.evidence is None:
        return _timed(cell, names, lambda name: cell.run(name, seed=options.seed))
    with begin_evidence(cell, Path(options.evidence), names, options.seed, images=options.images) as collector:
        timed = _timed(cell, names, collector.run)
        collector.settle()
    return timed


def _filming(file: str, cell: MockCell, names: Sequence[str], seed: int) -> Callable[[str], RehearsalResult]:
    """Return what runs the one rehearsal and writes its film."""
    with gate(FILM):
        from cellc.mock.command.film import encoder, filmed
    path = Path(file)
    if len(names) != 1:
        raise MockError(path.as_posix(), f"is a film of one rehearsal, got {len(names)}; name it with --rehearsal")
    encoder(path)  # or it refuses, before anything runs
    return lambda name: filmed(cell, name, seed, path)


def _timed(
    cell: MockCell,
    names: Sequence[str],
    run: Callable[[str], RehearsalResult],
    executed_s: Callable[[], float] | None = None,
) -> list[TimedResult]:
    """Run rehearsals in turn; ``executed_s`` says what the last one needed, where more than that passed by."""
    timed: list[TimedResult] = []
    with progress("mock") as update:
        for number, name in enumerate(in_turn(cell, names), start=1):
            update(f"rehearsal {number} of {len(names)}, {name}")
            start = perf_counter()
            result = run(name)
            timed.append(TimedResult(result, perf_counter() - start if executed_s is None else executed_s()))
    return timed


def begin_live(live: Live) -> AbstractContextManager[LiveView]:
    """Return what shows rehearsals in Foxglove while it is open.

    Raises:
        MissingExtraError: a package is not installed.
    """
    with gate(LIVE):
        from cellc.mock.command.live import live_view
    return live_view(live.address, live.speed)


def keep_evidence(
    cell: MockCell,
    runs: Mapping[str, SweepRun | None],
    options: FolderOptions,
    campaign: Campaign | None = None,
    sweeps: Sequence[Sweep] = (),
    physics: PhysicsRuns = NO_PHYSICS,
) -> None:
    """Run rehearsals and write what they leave, with a report over all, where evidence is asked for.

    Args:
        runs: names of rehearsals, each with the run of a sweep that it makes again.

    Raises:
        MissingExtraError, MockError: as ``begin_evidence``.
    """
    if options.evidence is None:
        return
    with begin_evidence(cell, Path(options.evidence), tuple(runs), options.seed) as collector:
        for name, swept in runs.items():
            collector.run(name, swept)
        collector.settle(campaign, sweeps, physics)


def begin_evidence(
    cell: MockCell, folder: Path, names: Sequence[str], seed: int, *, images: bool = False
) -> EvidenceCollector:
    """Return what runs rehearsals of a cell and writes their evidence to a folder.

    Args:
        images: draw what cameras see.

    Raises:
        MissingExtraError: the package that writes bags is not installed.
        MockError: a name is unknown, or the folder cannot take the evidence.
    """
    from cellc.mock.command.evidence import EvidenceCollector

    for name in names:
        cell.entry(name)
    return EvidenceCollector(cell, folder, names, seed, images=images)
