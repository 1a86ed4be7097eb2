"""The rehearsals of many generated folders, each in its own process or worker; their sweeps one after the other."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter, process_time

from cellc.contract.compute.work import Work, in_order, stream
from cellc.contract.fleet import FleetRehearsal, FleetSweep
from cellc.contract.limits import limits, option
from cellc.contract.printing import progress, time_left
from cellc.contract.vocabulary import UNKNOWN
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
    """A generated folder of a call.

    Attributes:
        name: as the user knows it.
        read: None where it cannot be executed, and ``problem`` says why.
    """

    name: str
    read: GeneratedFolder | None
    problem: str = ""


@dataclass(frozen=True, slots=True)
class Rehearsed:
    """What became of a folder: its rehearsals or its sweeps, and its processor time."""

    rehearsals: tuple[FleetRehearsal, ...] | None = None
    sweeps: tuple[FleetSweep, ...] | None = None
    problem: str = ""
    seconds: float = field(default=0.0, compare=False)

    @property
    def passed(self) -> bool:
        """Whether everything ended as it must."""
        swept = all(sweep.verdict in (None, "passed") for sweep in self.sweeps or ())
        return not self.problem and swept and all(rehearsal.passed for rehearsal in self.rehearsals or ())


def member_of(name: str, folder: Path, *, edited: bool, spec: Path | None = None) -> Member:
    """Read a generated folder.

    Args:
        spec: folder of the spec, where the package lies elsewhere than it will.
    """
    try:
        read = read_to_run(folder, edited=edited)
    except MockError as problem:
        return Member(name, None, str(problem))
    return Member(name, read if spec is None else replace(read, mesh_roots=(spec, *read.mesh_roots)))


def rehearse_all(members: Sequence[Member], options: RehearsalOptions) -> Iterator[Rehearsed]:
    """Yield what became of each folder, in their order.

    Raises:
        ComputeError: no worker can execute one.
    """
    start = perf_counter()
    spent_s = 0.0
    with progress("mock") as update, closing(_rehearsed(members, options)) as ended:
        for number, member in enumerate(members):
            left = time_left(number, len(members), perf_counter() - start)
            update(f"{number + 1} of {len(members)}, {member.name}{left}")
            if member.read is None:
                yield Rehearsed((), problem=member.problem)
            elif spent_s > limits().command_seconds:
                yield Rehearsed((), problem=_TOO_LONG.format(limits().command_seconds))
            else:
                done = next(ended)
                spent_s += done.seconds
                yield done


def _rehearsed(members: Sequence[Member], options: RehearsalOptions) -> Generator[Rehearsed, None, None]:
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


def _begin(_: None) -> Callable[[Assignment], Rehearsed]:
    return _rehearse


def _rehearse(assignment: Assignment) -> Rehearsed:
    start_s = process_time()
    try:
        cell = assignment.cell()
        results = [cell.run(name, seed=assignment.seed) for name in in_turn(cell, cell.rehearsals)]
    except MockError as problem:
        return Rehearsed((), problem=str(problem))
    return Rehearsed(
        tuple(
            FleetRehearsal(name=result.name, outcome=result.outcome, expected=result.expected, passed=result.passed)
            for result in results
        ),
        seconds=process_time() - start_s,
    )


def sweep_all(members: Sequence[Member], options: SweepOptions) -> Iterator[Rehearsed]:
    """Yield how often the rehearsals of each folder succeed, in their order; no sweep where a cell draws nothing."""
    for member in members:
        if member.read is None or member.read.uncertainty is None:
            yield Rehearsed(sweeps=(), problem=member.problem)
            continue
        try:
            cell = cell_of(member.read)
            sweeps = [sweep_entry(cell, entry, options) for entry in entries_to_sweep(cell, options)]
            yield Rehearsed(sweeps=tuple(map(_as_entry, sweeps)))
        except MockError as problem:
            yield Rehearsed(sweeps=(), problem=str(problem))


def _as_entry(sweep: Sweep) -> FleetSweep:
    words = {True: "passed", False: "failed", None: UNKNOWN}
    return FleetSweep.model_validate(
        {
            "rehearsal": sweep.rehearsal,
            "runs": len(sweep.runs),
            "succeeded": len(sweep.runs) - len(sweep.failed),
            "low": sweep.rate.low,
            "high": sweep.rate.high,
            "confidence": sweep.rate.confidence,
            "verdict": None if sweep.expected is None else words[sweep.verdict],
        }
    )
