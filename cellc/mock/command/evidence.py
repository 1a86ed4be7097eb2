"""Runs rehearsals and writes their evidence: a bag, records and figures of each, and one report over all."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock.campaign.campaign import Campaign
from cellc.mock.cell import MockCell
from cellc.mock.evidence.bag.bag_file import Bag
from cellc.mock.evidence.folder import EvidenceFolder, file_names
from cellc.mock.evidence.images.photographer import Album, Photographer, Shot, photograph
from cellc.mock.evidence.kpis import Kpi, kpis, to_kpi_json
from cellc.mock.evidence.layout import to_layout
from cellc.mock.evidence.listener import RunListener
from cellc.mock.evidence.run_bag import RunBag
from cellc.mock.evidence.run_trace import RunTrace, TraceResult
from cellc.mock.folder import path_tolerances
from cellc.mock.gates import NO_PHYSICS, PhysicsRuns, judged_campaign, judged_rehearsals, sign_gates
from cellc.mock.plant import Plant
from cellc.mock.report_page.page import ReportContent, to_report
from cellc.mock.report_page.run_section import RunEvidence
from cellc.mock.result import RehearsalResult, to_json_lines
from cellc.mock.sweep.runs import SweepRun
from cellc.mock.sweep.sweep import Sweep
from cellc.mock.task.bounds import joint_state_age_s

REPORT = "report.html"
LAYOUT = "layout.json"
"""Foxglove imports it, and shows the bags by it."""


class EvidenceCollector:
    """Runs rehearsals of one call; used as a context, so that nothing half done is left behind."""

    def __init__(self, cell: MockCell, folder: Path, names: Sequence[str], seed: int, *, images: bool = False) -> None:
        """Make ready to run rehearsals by name.

        Args:
            images: draw what cameras see.

        Raises:
            MockError: the folder cannot take the evidence.
        """
        self._runs: list[RunEvidence] = []
        self._cell = cell
        self._tolerances = path_tolerances(cell.folder.parameters)
        self._seed = seed
        self._images = images
        self._stems = file_names(names)
        files = [REPORT, LAYOUT, *(name for stem in self._stems.values() for name in _files(stem))]
        self._folder = EvidenceFolder(folder, files)

    def __enter__(self) -> EvidenceCollector:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._folder.discard()

    def run(self, name: str, swept: SweepRun | None = None) -> RehearsalResult:
        """Run a rehearsal, or a run of a sweep again, and keep its evidence.

        Raises:
            MockError: it names what the contract does not have.
        """
        entry = self._cell.entry(name)
        bag_file, records_file, kpis_file = _files(self._stems[entry.name])
        with self._folder.open(bag_file) as file:
            result, trace = recorded(self._cell, entry, file, self._seed, images=self._images)
        figures = () if trace is None else self._figures(result, trace)
        self._folder.write(records_file, to_json_lines(result.attempts))
        self._folder.write(kpis_file, to_kpi_json(entry, result, figures))
        files = (bag_file, records_file, kpis_file)
        self._runs.append(RunEvidence(entry, result, trace, figures, self._tolerances, files, swept))
        return result

    def settle(
        self, campaign: Campaign | None = None, sweeps: Sequence[Sweep] = (), physics: PhysicsRuns = NO_PHYSICS
    ) -> None:
        """Write the report and put everything in its place.

        Args:
            campaign: what a campaign found, which the report shows and the gates are judged by too.
            sweeps: what sweeps found, which the report shows and the gates are judged by too.
            physics: rehearsals with masses, which the gates are judged by too.

        Raises:
            MockError: the folder cannot take it.
        """
        contract = self._cell.contract
        runs = judged_rehearsals(self._cell.entries, [run.result for run in self._runs])
        if masses := self._cell.folder.masses:
            physics = PhysicsRuns(tuple(run.result for run in self._runs), "", masses)
        if campaign is not None:
            runs = (*runs, *judged_campaign(campaign))
        gates = sign_gates(self._cell.folder, runs, self._seed, sweeps, physics)
        content = ReportContent(
            contract, self._cell.notes, self._seed, tuple(self._runs), gates, campaign, tuple(sweeps)
        )
        self._folder.write(LAYOUT, to_layout(contract))
        self._folder.write(REPORT, to_report(content))
        self._folder.settle({"cell": contract.cell, "configuration_id": contract.configuration_id, "seed": self._seed})

    def _figures(self, result: RehearsalResult, trace: TraceResult) -> tuple[Kpi, ...]:
        contract = self._cell.contract
        return kpis(contract.kpis, result, trace, joint_state_age_s(contract))


def recorded(
    cell: MockCell,
    entry: RehearsalEntry,
    file: BinaryIO,
    seed: int,
    *,
    images: bool = False,
    albums: list[Album] | None = None,
) -> tuple[RehearsalResult, TraceResult | None]:
    """Run a rehearsal and write its bag to a file; the trace is None where the cell never started.

    Args:
        images: draw what cameras deliver, and write it to the bag.
        albums: takes what cameras deliver, to be drawn afterwards; the bag has their topics.

    Raises:
        MockError: it names what the contract does not have.
    """
    watched: list[tuple[RunListener, RunTrace]] = []
    bag = Bag(file, cell.contract.distro, _identity(cell, entry, seed))

    def watch(plant: Plant) -> None:
        writer, trace = RunBag(bag, plant), RunTrace(plant)
        writer.begin(cell.folder.urdf)
        if images or albums is not None:
            album = Album(Photographer(plant, cell.folder.description, cell.folder.mesh_roots))
            writer.images(album.photographer.topics())
            photograph(plant, album, partial(_draw, writer, album.photographer) if images else album.take)
            if albums is not None:
                albums.append(album)
        watched.append((RunListener(plant, writer, trace), trace))

    result = cell.rehearse(entry, seed=seed, watch=watch)
    for listener, _ in watched:
        listener.end()
    bag.finish()
    return result, watched[0][1].result() if watched else None


def _draw(bag: RunBag, photographer: Photographer, shot: Shot, now_ns: int) -> None:
    for topic, data in photographer.drawn(shot):
        bag.image(topic, data, now_ns)


def _identity(cell: MockCell, entry: RehearsalEntry, seed: int) -> dict[str, str]:
    contract = cell.contract
    return {
        "cell": contract.cell,
        "configuration_id": contract.configuration_id,
        "rehearsal": entry.name,
        "seed": str(seed),
        **({"masses": masses} if (masses := cell.folder.masses) else {}),
        **{f"version.{part}": version for part, version in sorted(contract.version_tuple.items())},
    }


def _files(stem: str) -> tuple[str, str, str]:
    return f"{stem}.mcap", f"{stem}.records.jsonl", f"{stem}.kpis.json"
