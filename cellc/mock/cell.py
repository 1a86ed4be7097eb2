"""A loaded cell: runs rehearsals by name, from a cell that is off to a named end."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import process_time

from cellc.contract.attempt import AttemptRecord
from cellc.contract.contract import Contract
from cellc.contract.frozen import dataclass
from cellc.contract.limits import Budget, BudgetError, limits, option
from cellc.contract.printing import stage
from cellc.contract.rehearsals import RehearsalEntry
from cellc.contract.signals import within
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.assemble import assemble, start_nodes
from cellc.mock.bringup import Bringup
from cellc.mock.bus.qos import unmatched_pairs
from cellc.mock.by_hand import notes_on, refuse_not_executed
from cellc.mock.control import ManagerAbortedError
from cellc.mock.errors import LimitReachedError, MockError, OversleptError
from cellc.mock.faults.ports import FaultPorts, fault_ports
from cellc.mock.faults.registry import Injection, any_started, build_fault, response_s
from cellc.mock.folder import GeneratedFolder, goal_tolerances, in_stage, path_tolerances, read_folder
from cellc.mock.nodes.motion_model import build_motion_model
from cellc.mock.nodes.motion_planner import PlanMemory
from cellc.mock.physics.off_plan import off_plan
from cellc.mock.physics.reading import with_scene
from cellc.mock.plant import Plant
from cellc.mock.reality import AS_STATED, Reality
from cellc.mock.result import RehearsalResult, RunFailure, StageEvidence
from cellc.mock.snapshot import SnapshotMemory, has_same_bring_up
from cellc.mock.task.context import TaskContext
from cellc.mock.task.mass import findings
from cellc.mock.task.task import EXECUTED, Steps, Task

Watch = Callable[[Plant], None]
"""Called with the plant before anything runs: recorders of evidence listen from the first cycle on."""


@dataclass(frozen=True, slots=True)
class _Run:
    """One run of a rehearsal.

    Attributes:
        watch: sees the plant first, and another one where the run is made again; it must not change anything.
        reality: where the cell differs from what its folder says.
        snapshots: copies of the cell that the run may begin with; None where it must begin with a cell that is off.
        steps: what executes the steps of the task.
    """

    folder: GeneratedFolder
    memory: PlanMemory
    rehearsal: RehearsalEntry
    seed: int
    watch: Watch | None
    reality: Reality
    snapshots: SnapshotMemory | None
    steps: Steps

    def result(self) -> RehearsalResult:
        """Run the rehearsal to its named end.

        Raises:
            MockError: a fault names what the contract does not have.
        """
        try:
            result = within(limits().rehearsal_seconds, self._ended)
            if result is None:
                most = f"a rehearsal must take at most {limits().rehearsal_seconds} s of processor time"
                raise LimitReachedError(most, "rehearsal-seconds")
        except LimitReachedError as error:
            result = _not_run(self.rehearsal, error)
        return replace(result, edited=self.folder.edited, unseen=self.memory.model.unseen)

    def _ended(self) -> RehearsalResult:
        try:
            return self._executed(may_oversleep=self.snapshots is not None and not self.rehearsal.faults)
        except OversleptError:
            return self._executed(may_oversleep=False)

    def _executed(self, *, may_oversleep: bool) -> RehearsalResult:
        rehearsal = self.rehearsal
        injections = [Injection(entry, build_fault(entry, self.folder.contract)) for entry in rehearsal.faults]
        alike = rehearsal.bring_up == "mock" and all(entry.phase is None for entry in rehearsal.faults)
        alike &= self.folder.scene is None or self.reality == AS_STATED  # what has masses lies where it is drawn
        snapshots = self.snapshots if alike else None
        copied = None if snapshots is None else self._resumed(snapshots)
        if copied is not None:
            plant, evidence = copied
            return self._run_task(plant, fault_ports(plant), injections, evidence, may_oversleep)
        try:
            plant = assemble(self.folder, self.memory, self.seed, rehearsal.bring_up, self.reality)
        except ManagerAbortedError as aborted:
            stage = StageEvidence("discover", (), (f"the controller manager ended: {aborted.reason}",))
            return _not_up(rehearsal, (stage,), unmatched_pairs(self.folder.contract))
        if self.watch is not None:
            self.watch(plant)
        start_nodes(plant)
        ports = fault_ports(plant)
        for injection in injections:
            if injection.entry.phase is not None:
                injection.schedule(ports, plant.now_ns)
        bringup = Bringup(plant)
        if snapshots is None:
            plant.simulation.run_process(bringup.run())
        else:
            snapshots.bring_up(plant, bringup)
        evidence = tuple(bringup.evidence)
        if not bringup.passed:
            failed = AttemptOutcome.CLAIM_FAILURE if plant.effects.refused else RunFailure.BRINGUP_FAILURE
            outcome = AttemptOutcome.UNCOMMANDED_MOTION if plant.effects.motions else failed
            return _not_up(rehearsal, evidence, _findings(plant), outcome)
        return self._run_task(plant, ports, injections, evidence, may_oversleep)

    def _resumed(self, snapshots: SnapshotMemory) -> tuple[Plant, tuple[StageEvidence, ...]] | None:
        """Return a plant that is after its bring-up; None where it must be brought up."""
        known = snapshots.get()
        if known is None:
            return None
        plant = assemble(self.folder, self.memory, self.seed, "mock", self.reality, known.control())
        if not has_same_bring_up(plant):
            return None
        if self.watch is not None:
            self.watch(plant)
        start_nodes(plant)
        known.resume(plant)
        return plant, known.evidence

    def _run_task(
        self,
        plant: Plant,
        ports: FaultPorts,
        injections: Sequence[Injection],
        evidence: tuple[StageEvidence, ...],
        may_oversleep: bool,
    ) -> RehearsalResult:
        """Inject the faults at their times, and run the task to its named end."""
        rehearsal, start_ns, dynamics = self.rehearsal, plant.now_ns, plant.control.dynamics
        if dynamics is not None:
            dynamics.contacts.begin()
        plant.loads.draw(self.reality)
        if rehearsal.bring_up == "real":
            plant.start.operator_takes_over()
        for injection in injections:
            if injection.entry.phase is None:
                injection.schedule(ports, start_ns)
        disturbed = partial(any_started, injections)
        deadline_ns = start_ns + round(rehearsal.timeout_s * 1e9)
        task = Task(rehearsal, TaskContext(plant, deadline_ns, self.seed, disturbed, may_oversleep), self.steps)
        plant.simulation.run_process(task.run())
        absent = tuple(injection.describe_absence() for injection in injections if injection.start_ns is None)
        return RehearsalResult(
            name=rehearsal.name,
            outcome=task.outcome,
            expected=rehearsal.expect,
            sim_time_s=(plant.now_ns - start_ns) / 1e9,
            response_s=response_s(injections, task.records),
            within_s=rehearsal.within_s,
            attempts=tuple(task.records),
            bringup=evidence,
            findings=(*_findings(plant), *self._of_motions(plant, task.records), *absent),
            contacts=() if dynamics is None else tuple(dynamics.contacts),
            vacuous=bool(absent) and (len(absent) == len(injections) or task.outcome is AttemptOutcome.SUCCEEDED),
        )

    def _of_motions(self, plant: Plant, records: Sequence[AttemptRecord]) -> Iterator[str]:
        """Yield how far motions with masses were from their plans, where a bound of the contract is near."""
        dynamics, parameters = plant.control.dynamics, self.folder.parameters
        if dynamics is not None:
            spans = [
                (record.step, record.started_ns, record.ended_ns)
                for record in records[:-1]
                if record.outcome == AttemptOutcome.SUCCEEDED and record.controller_name is not None
            ]
            yield from off_plan(dynamics, spans, path_tolerances(parameters), goal_tolerances(parameters))


def _not_run(rehearsal: RehearsalEntry, error: LimitReachedError) -> RehearsalResult:
    return _not_up(rehearsal, (StageEvidence("limits", (), (str(error),)),), (), RunFailure.LIMIT_REACHED)


def _not_up(
    rehearsal: RehearsalEntry,
    evidence: tuple[StageEvidence, ...],
    findings: tuple[str, ...],
    outcome: AttemptOutcome | RunFailure = RunFailure.BRINGUP_FAILURE,
) -> RehearsalResult:
    return RehearsalResult(
        name=rehearsal.name,
        outcome=outcome,
        expected=rehearsal.expect,
        sim_time_s=0.0,
        response_s=None,
        within_s=rehearsal.within_s,
        attempts=(),
        bringup=evidence,
        findings=findings,
    )


def _findings(plant: Plant) -> tuple[str, ...]:
    plant.robot_state_publisher.catch_up(plant.now_ns)  # what the listener refuses, it refuses when it arrives
    return (
        *unmatched_pairs(plant.contract),
        *plant.network.events.lines(),
        *plant.task.buffer.conflicts,
        *plant.task.buffer.warnings.lines(),
        *plant.network.disconnections,
        *plant.control.dangers,
        *plant.effects.dangers,
        *findings(plant),
    )


_SHOWN = 12  # links that are named in one line; all are counted


class MockCell:
    """A generated folder ready to be executed; every run starts from a cell that is off."""

    def __init__(
        self, folder: GeneratedFolder, memory: PlanMemory, realities: Mapping[str, Reality] | None = None
    ) -> None:
        """Bind what ``load`` has read; ``realities`` has what is different in rehearsals of these names."""
        self._folder = folder
        self._memory = memory
        self._snapshots = SnapshotMemory()
        self._realities = realities or {}

    def with_realities(self, folder: GeneratedFolder, realities: Mapping[str, Reality]) -> MockCell:
        """Return this cell with other rehearsals, some of which differ from what the folder says."""
        return MockCell(folder, self._memory, realities)

    def __repr__(self) -> str:
        return f"<MockCell {self.contract.cell}: {', '.join(self.rehearsals) or 'no rehearsals'}>"

    @property
    def folder(self) -> GeneratedFolder:
        """What was read of the generated folder."""
        return self._folder

    @property
    def contract(self) -> Contract:
        """The contract of the cell."""
        return self._folder.contract

    @property
    def rehearsals(self) -> tuple[str, ...]:
        """Names of the rehearsals in the order of the folder."""
        return tuple(entry.name for entry in self.entries)

    @property
    def entries(self) -> tuple[RehearsalEntry, ...]:
        """The rehearsals themselves."""
        return self._folder.rehearsals

    @property
    def unseen(self) -> tuple[str, ...]:
        """Links with a shape whose mesh is not there: nothing is planned round them."""
        return self._memory.model.unseen

    @property
    def notes(self) -> tuple[str, ...]:
        """How the folder differs from its manifest, its stage, and which links lack a collision mesh, one line each."""
        return (*self._folder.notes, *self._folder.staged, *self._unseen_notes())

    def _unseen_notes(self) -> Iterator[str]:
        """Yield the links whose meshes are not there: those first that move, for they may hit anything."""
        model = self._memory.model
        lines = (
            f"{len(links)} that {word}, {', '.join(f'`{link}`' for link in links[:_SHOWN])}"
            for word, stand in (("move", False), ("do not move", True))
            if (links := [link for link in model.unseen if model.links.is_fixed(link) is stand])
        )
        if named := "; ".join(lines):
            yield f"these links are not checked for collision, because their meshes are missing: {named}"

    def entry(self, rehearsal: str) -> RehearsalEntry:
        """Return a rehearsal of the folder.

        Raises:
            MockError: no rehearsal has this name.
        """
        for entry in self.entries:
            if entry.name == rehearsal:
                return entry
        known = ", ".join(f"`{name}`" for name in self.rehearsals) or "none"
        raise MockError(self.contract.files.rehearsals, f"has no rehearsal `{rehearsal}`; it has {known}")

    def run(self, rehearsal: str, *, seed: int = 0) -> RehearsalResult:
        """Run one rehearsal; the same folder and seed give the same result to the last bit.

        Raises:
            MockError: there is no rehearsal of this name, or it names what the contract does not have.
        """
        return self.rehearse(self.entry(rehearsal), seed=seed)

    def rehearse(
        self,
        entry: RehearsalEntry,
        *,
        seed: int = 0,
        watch: Watch | None = None,
        reality: Reality | None = None,
        from_off: bool = True,
        steps: Steps = EXECUTED,
    ) -> RehearsalResult:
        """Run a rehearsal that need not stand in the folder; ``watch`` sees the plant before anything runs.

        Args:
            from_off: bring the cell up where ``watch`` is given, so that it sees that too, and run once; else a copy
                may do, and a run that is made again, whose plant ``watch`` sees last.
            steps: what executes the steps of the task.

        Raises:
            MockError: it names what the contract does not have.
        """
        known = self._realities.get(entry.name, AS_STATED) if reality is None else reality
        snapshots = None if from_off and watch is not None else self._snapshots
        return _Run(self._folder, self._memory, entry, seed, watch, known, snapshots, steps).result()


def load(folder: Path, *, edited: bool = False, stage: str = "", physics: bool = False) -> MockCell:
    """Load a generated folder.

    Args:
        edited: take a folder that differs from its manifest; every result says so, and no gate is signed.
        stage: the stage of commissioning that motion is planned in; the last where it is empty.
        physics: give joints and parts their masses.

    Raises:
        MockError: the folder cannot be executed, or a file was edited that is not; names it and why.
    """
    return cell_of(read_to_run(folder, edited=edited, stage=stage, physics=physics))


def read_to_run(folder: Path, *, edited: bool = False, stage: str = "", physics: bool = False) -> GeneratedFolder:
    """Read a generated folder as `load` does, with notes on what is odd about it, before any model is built."""
    read = read_to_show(folder, edited=edited)
    read = with_scene(read, folder) if physics else read
    refuse_not_executed(read)
    return in_stage(read, folder, stage) if stage else read


def read_to_show(folder: Path, *, edited: bool = False) -> GeneratedFolder:
    """Read a generated folder as `read_to_run` does, but leave edits that no run shows to the notes.

    Raises:
        MockError: the folder cannot be executed, or is edited and may not be.
    """
    stage(f"reading {folder.as_posix()}")
    read = read_folder(folder, edited=edited)
    return replace(read, notes=(*read.notes, *notes_on(read)))


def cell_of(folder: GeneratedFolder) -> MockCell:
    """Make a folder that was read ready to be executed.

    Raises:
        MockError: its parts do not fit together.
    """
    model = build_motion_model(
        folder.contract,
        folder.urdf,
        folder.description,
        folder.allowed_collisions,
        folder.mesh_roots,
        folder.capped_by,
    )
    return MockCell(folder, PlanMemory(model))


def in_turn(cell: MockCell, names: Iterable[str]) -> Iterator[str]:
    """Yield the names of rehearsals, each of which is run before the next is asked for.

    Raises:
        MockError: they took the processor time that those of one folder may take together.
    """
    budget = Budget(limits().rehearsal_seconds, process_time)
    try:
        yield from budget.over(names)
    except BudgetError:
        most = f"must take at most {limits().rehearsal_seconds} s of processor time together, got more"
        raise MockError(cell.contract.files.rehearsals, f"{most}; {option('rehearsal-seconds')}") from None


def run_all(cell: MockCell, *, seed: int = 0) -> tuple[RehearsalResult, ...]:
    """Run every rehearsal of a cell in the order of its folder."""
    return tuple(cell.run(name, seed=seed) for name in in_turn(cell, cell.rehearsals))
