"""The other side of a comparison: a rehearsal that is run for it, a bag or a file of records."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from cellc.contract.store.swap import open_new, temporary_folder
from cellc.mock.cell import cell_of
from cellc.mock.command.evidence import recorded
from cellc.mock.folder import GeneratedFolder
from cellc.tools.attempt.bag import BagError
from cellc.tools.attempt.compare import compare
from cellc.tools.attempt.read import Drawn, Listen, read_attempt
from cellc.tools.attempt.record import Report
from cellc.tools.attempt.recorded import SUFFIXES, recorded_report


@dataclass(frozen=True, slots=True)
class Other:
    """The other side.

    Attributes:
        rehearsal: its name, where it was run for the comparison.
    """

    name: str
    report: Report
    rehearsal: str | None = None


def compared(report: Report, folder: GeneratedFolder, against: str, drawn: Drawn) -> Report:
    """Return a report with its comparison; for `against` and errors see `other_side`."""
    other = other_side(report.task, folder, against, drawn)
    return replace(report, comparison=compare(report, other.report, other.name))


def other_side(
    task: str | None, folder: GeneratedFolder, against: str, drawn: Drawn, seed: int = 0, listen: Listen | None = None
) -> Other:
    """Return what an attempt is compared with.

    Args:
        task: rehearsal whose steps the attempt made.
        against: name of a rehearsal of the folder, or where a bag or a file of records lies.
        seed: of the rehearsal.
        listen: takes each message of a bag too.

    Raises:
        BagError: it is neither.
        MockError: the rehearsal cannot be run.
    """
    names = [entry.name for entry in folder.rehearsals]
    if against in names:
        return Other(f"rehearsal {against}", _rehearsed(folder, against, drawn, seed), against)
    place = Path(against)
    if not place.exists():
        known = ", ".join(f"`{name}`" for name in names) or "none"
        raise BagError(f"`{against}` must be a bag, a file of records or a rehearsal of the package; it has {known}")
    if place.suffix in SUFFIXES:
        return Other(place.as_posix(), recorded_report(place, folder.contract, task))
    named = None if place.stem in names else task
    report = read_attempt([place], folder.contract, folder.rehearsals, folder.watches, named, drawn, listen)
    return Other(place.as_posix(), report)


def _rehearsed(folder: GeneratedFolder, name: str, drawn: Drawn, seed: int) -> Report:
    cell = cell_of(folder)
    with temporary_folder("cellc-rehearsal-") as place:
        bag = place / f"{name}.mcap"
        with open_new(bag) as file:
            recorded(cell, cell.entry(name), file, seed)
        return read_attempt([bag], folder.contract, folder.rehearsals, folder.watches, name, drawn)
