"""Runs that gates are judged by: what was injected, how it ended, and whether that is as it must be."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from cellc.contract.attempt import AttemptRecord, PacketStep
from cellc.contract.contract import Contract
from cellc.contract.extras import MissingExtraError
from cellc.contract.fault_declaration import Interaction
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry, RehearsalEntry
from cellc.mock.campaign.campaign import Campaign
from cellc.mock.campaign.limits import LimitsReport
from cellc.mock.cell import MockCell, in_turn
from cellc.mock.errors import MockError
from cellc.mock.folder import GeneratedFolder
from cellc.mock.physics.reading import with_scene
from cellc.mock.result import RehearsalResult
from cellc.mock.sweep.sweep import Sweep


@dataclass(frozen=True, slots=True)
class JudgedRun:
    """One run.

    Attributes:
        declared: it is a rehearsal of the folder, not a run of a campaign.
        passed: it ended in an outcome that its faults may have, within its bound.
        limits: how commands compare with limits; None where they were not checked.
    """

    entry: RehearsalEntry
    result: RehearsalResult
    declared: bool
    passed: bool
    limits: LimitsReport | None

    @property
    def name(self) -> str:
        """The run as its evidence names it."""
        return self.entry.name

    @property
    def undisturbed(self) -> bool:
        """Tell whether no fault was injected."""
        return not self.entry.faults

    def has_mark(self, attempt: AttemptRecord, *steps: PacketStep) -> bool:
        """Return whether the packet of an attempt passed all these steps."""
        return set(steps) <= {point.step for point in attempt.trace}


@dataclass(frozen=True, slots=True)
class PhysicsRuns:
    """Rehearsals of the folder whose joints and parts have masses.

    Attributes:
        needed: what would show them; empty where they were run.
        computed_by: library and version.
    """

    results: tuple[RehearsalResult, ...]
    needed: str
    computed_by: str = ""


NO_PHYSICS = PhysicsRuns((), "`cellc gates` where MuJoCo is installed (extra `physics`): it was not run with masses")


def rehearsed_with_masses(cell: MockCell, folder: Path, seed: int) -> PhysicsRuns:
    """Run the rehearsals of a folder with masses; none where MuJoCo is not installed, or cannot read the scene."""
    try:
        read = with_scene(cell.folder, folder)
    except MissingExtraError:
        return NO_PHYSICS
    except MockError as error:
        return PhysicsRuns((), str(error))
    having = cell.with_realities(read, {})
    return PhysicsRuns(
        tuple(having.run(name, seed=seed) for name in in_turn(having, having.rehearsals)), "", read.masses
    )


@dataclass(frozen=True, slots=True)
class GateEvidence:
    """Everything that gates are judged by."""

    folder: GeneratedFolder
    runs: tuple[JudgedRun, ...]
    sweeps: tuple[Sweep, ...] = ()
    physics: PhysicsRuns = NO_PHYSICS

    @property
    def contract(self) -> Contract:
        """The contract of the cell."""
        return self.folder.contract

    def undisturbed(self) -> tuple[JudgedRun, ...]:
        """Return the runs without faults."""
        return tuple(run for run in self.runs if run.undisturbed)

    def attempts(self, controller: str) -> Iterator[tuple[JudgedRun, AttemptRecord]]:
        """Yield the attempts of all runs that sent a goal to a controller."""
        for run in self.runs:
            for attempt in run.result.attempts:
                if attempt.controller_name == controller:
                    yield run, attempt

    def with_fault(self, case: Interaction) -> Iterator[tuple[JudgedRun, FaultEntry]]:
        """Yield the runs with a fault that provokes a case of the S2 checklist, and the fault."""
        for run in self.runs:
            for fault in run.entry.faults:
                if case in fault.kind.shows:
                    yield run, fault


def judged_rehearsals(entries: Sequence[RehearsalEntry], results: Iterable[RehearsalResult]) -> tuple[JudgedRun, ...]:
    """Return declared rehearsals with their verdicts; ``entries`` are those of the folder."""
    known = {entry.name: entry for entry in entries}
    return tuple(JudgedRun(known[result.name], result, True, result.passed, None) for result in results)


def judged_campaign(campaign: Campaign) -> tuple[JudgedRun, ...]:
    """Return the runs of a campaign with their verdicts; its undisturbed runs are declared rehearsals."""
    return tuple(
        JudgedRun(end.run.entry, end.result, not end.run.hits, end.named and end.in_time, end.limits)
        for end in campaign.all_ends
    )
