"""The rehearsals of many generated folders, each in its own process or worker; their sweeps one after the other."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time
from typing import Literal

from cellc.contract.compute.work import Work, in_order, stream
from cellc.contract.diagnostics.wording import time_left
from cellc.contract.fleet import FleetRehearsal, FleetRow, FleetSweep
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits, option
from cellc.contract.printing import progress
from cellc.mock.campaign.campaign import Assignment
from cellc.mock.cell import cell_of, in_turn, read_to_run
from cellc.mock.command.campaign import executor
from cellc.mock.command.options import RehearsalOptions, SweepOptions
from cellc.mock.command.sweep import entries_to_sweep, sweep_entry
from cellc.mock.errors import MockError
from cellc.mock.folder import GeneratedFolder
from cellc.mock.sweep.sweep import Sweep
from cellc.robot.description.packages import package_path

_TOO_LONG = "the rehearsals of all folders must take at most {} s of processor time together; " + option(
    "command-seconds"
)


@dataclass(frozen=True, slots=True)
class Member:
    """A generated folder of a call: its row as far as it is known, and what is executed; None where nothing can be."""

    row: FleetRow
    read: GeneratedFolder | None


@dataclass(frozen=True, slots=True)
class _Ended:
    """How the rehearsals of a folder ended, or why they could not be run, and the processor time of it."""

    rehearsals: tuple[FleetRehearsal, ...]
    problem: str
    seconds: float


def member_of(row: FleetRow, folder: Path, *, edited: bool, spec: Path | None = None) -> Member:
    """Read a generated folder.

    Args:
        row: of it, or of the spec that it was made of for this call.
        spec: folder of the spec, where the package lies elsewhere than it will.
    """
    try:
        read = read_to_run(folder, edited=edited)
    except MockError as problem:
        return Member(replace(row, passed=False, problem=str(problem)), None)
    contract = read.contract
    row = replace(row, cell=contract.cell, versions={"ros": contract.distro.value, **row.versions})
    return Member(row, read if spec is None else replace(read, mesh_roots=(spec, *read.mesh_roots)))


def rehearse_all(members: Sequence[Member], options: RehearsalOptions) -> Iterator[FleetRow]:
    """Yield the row of each folder with what became of its rehearsals, in their order.

    Raises:
        ComputeError: no worker can execute one.
    """
    start = perf_counter()
    spent_s = 0.0
    with progress("mock") as update, closing(_rehearsed(members, options)) as ended:
        for number, member in enumerate(members):
            row, left = member.row, time_left(number, len(members), perf_counter() - start)
            update(f"{number + 1} of {len(members)}, {row.label}{left}")
            if member.read is None:
                yield row
            elif spent_s > limits().command_seconds:
                yield replace(row, passed=False, problem=_TOO_LONG.format(limits().command_seconds), rehearsals=())
            else:
                done = next(ended)
                spent_s += done.seconds
                passed = row.passed and not done.problem and all(each.passed for each in done.rehearsals)
                yield replace(row, passed=passed, problem=done.problem, rehearsals=done.rehearsals)


def _rehearsed(members: Sequence[Member], options: RehearsalOptions) -> Generator[_Ended, None, None]:
    factory, _ = executor(options.fan)
    # Another computer may lack meshes; finding that out takes as long as a rehearsal.
    assigned = [
        Assignment.of(cell_of(member.read), options.seed)
        if options.fan.cluster is not None
        else Assignment(member.read, options.seed, limits(), package_path(), None)
        for member in members
        if member.read is not None
    ]
    if factory is None or len(assigned) < 2:
        return (_rehearse(item) for item in assigned)
    names = {item.folder.contract.configuration_id: item.folder.contract.cell for item in assigned}
    work = Work(_begin, None, lambda one: names[one.folder.contract.configuration_id])
    return in_order(stream(work, assigned, factory))


def _begin(_: None) -> Callable[[Assignment], _Ended]:
    return _rehearse


def _rehearse(assignment: Assignment) -> _Ended:
    start_s = process_time()
    try:
        cell = assignment.cell()
        results = [cell.run(name, seed=assignment.seed) for name in in_turn(cell, cell.rehearsals)]
    except MockError as problem:
        return _Ended((), str(problem), 0.0)
    ended = (
        FleetRehearsal(name=result.name, outcome=result.outcome, expected=result.expected, passed=result.passed)
        for result in results
    )
    return _Ended(tuple(ended), "", process_time() - start_s)


def sweep_all(members: Sequence[Member], options: SweepOptions) -> Iterator[FleetRow]:
    """Yield each row with how often its rehearsals succeed, in their order; no sweep where a cell draws nothing."""
    for member in members:
        if member.read is None or member.read.uncertainty is None:
            yield replace(member.row, sweeps=())
            continue
        try:
            cell = cell_of(member.read)
            sweeps = tuple(_swept(sweep_entry(cell, entry, options)) for entry in entries_to_sweep(cell, options))
        except MockError as problem:
            yield replace(member.row, passed=False, problem=str(problem), sweeps=())
            continue
        passed = member.row.passed and all(sweep.verdict in (None, "passed") for sweep in sweeps)
        yield replace(member.row, passed=passed, sweeps=sweeps)


def _swept(sweep: Sweep) -> FleetSweep:
    verdicts: Mapping[bool | None, Literal["passed", "failed", "UNKNOWN"]]
    verdicts = {True: "passed", False: "failed", None: "UNKNOWN"}
    return FleetSweep(
        rehearsal=sweep.rehearsal,
        runs=len(sweep.runs),
        succeeded=len(sweep.runs) - len(sweep.failed),
        low=sweep.rate.low,
        high=sweep.rate.high,
        confidence=sweep.rate.confidence,
        verdict=None if sweep.expected is None else verdicts[sweep.verdict],
    )
