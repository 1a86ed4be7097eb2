"""An attempt to be viewed: its bags read as `cellc attempt` reads them, and what it is compared with."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from cellc.contract.printing import stage
from cellc.mock.cell import cell_of
from cellc.mock.folder import GeneratedFolder, path_tolerances
from cellc.tools.attempt.against import other_side
from cellc.tools.attempt.compare import compare
from cellc.tools.attempt.read import Drawn, read_attempt
from cellc.tools.attempt.record import Report
from cellc.tools.view.bag_motion import PictureBuilder, Pictures
from cellc.tools.view.bag_run import bag_run, beside
from cellc.tools.view.playback import Run, play
from cellc.tools.view.skeleton import Skeleton


@dataclass(frozen=True, slots=True)
class Viewed:
    """An attempt as the page shows it.

    Attributes:
        report: with its comparison, where there is something to compare with.
        runs: the attempt, and its ghost where there is one.
        rehearsals: of the runs, those that are rehearsals of the mock: the last ones.
        step_s: least time between two pictures.
        no_ghost: why nothing is beside it; empty where something is.
    """

    report: Report
    runs: tuple[Run, ...]
    rehearsals: int
    step_s: float
    no_ghost: str


def viewed(
    folder: GeneratedFolder,
    skeleton: Skeleton,
    bags: tuple[Path, ...],
    task: str | None,
    against: str | None,
    seed: int,
) -> Viewed:
    """Read an attempt, and what it is compared with: the rehearsal whose steps it made where nothing else is named.

    Raises:
        BagError: a bag cannot be read, or is of another cell.
        MockError: a rehearsal cannot be run.
    """
    joints = folder.description.joints
    drawn = Drawn([joint.name for joint in joints if joint.slides], path_tolerances(folder.parameters))
    names = [joint.name for joint in joints if joint.movable]
    listener = PictureBuilder(names)
    report = read_attempt(bags, folder.contract, folder.rehearsals, folder.watches, task, drawn, listener.take)
    pictures = listener.pictures()
    run = _drawn("the attempt", report, pictures, skeleton)
    step_s, against = pictures.step_ns / 1e9, against or report.task
    if against is None:
        why = "no rehearsal is known; name one with --task or --against"
        return Viewed(report, (run,), 0, step_s, why)
    beside_it = PictureBuilder(names)
    other = other_side(report.task, folder, against, drawn, seed, beside_it.take)
    comparison = compare(report, other.report, other.name)
    report = replace(report, comparison=comparison)
    if other.rehearsal is not None:
        ghost = play(cell_of(folder), other.rehearsal, skeleton, seed)
    else:
        ghost = _drawn(other.name, other.report, beside_it.pictures(), skeleton)
    if not ghost.times:
        return Viewed(report, (run,), 0, step_s, f"{other.name} has no joint states")
    run = beside(run, 1, ghost, skeleton, comparison)
    return Viewed(report, (run, ghost), int(other.rehearsal is not None), step_s, "")


def _drawn(name: str, report: Report, pictures: Pictures, skeleton: Skeleton) -> Run:
    stage(f"posing {len(pictures.times_ns)} pictures")
    return bag_run(name, report, pictures, skeleton)
