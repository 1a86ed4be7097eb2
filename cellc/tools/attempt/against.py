"""The other side of a comparison: a rehearsal that is run for it, a bag or a file of records."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from cellc.contract.store.swap import open_new, temporary_folder
from cellc.mock.cell import cell_of
from cellc.mock.command.evidence import recorded
from cellc.mock.folder import GeneratedFolder
from cellc.tools.attempt.bag import BagError
from cellc.tools.attempt.compare import compare
from cellc.tools.attempt.read import Drawn, read_attempt
from cellc.tools.attempt.record import Report
from cellc.tools.attempt.recorded import SUFFIXES, recorded_report


def compared(report: Report, folder: GeneratedFolder, against: str, drawn: Drawn) -> Report:
    """Return a report with its comparison.

    Args:
        against: name of a rehearsal of the folder, or where a bag or a file of records lies.

    Raises:
        BagError: it is neither.
        MockError: the rehearsal cannot be run.
    """
    names = [entry.name for entry in folder.rehearsals]
    if against in names:
        other = _rehearsed(folder, against, drawn)
        return replace(report, comparison=compare(report, other, f"rehearsal {against}"))
    place = Path(against)
    if not place.exists():
        known = ", ".join(f"`{name}`" for name in names) or "none"
        raise BagError(f"`{against}` must be a bag, a file of records or a rehearsal of the package; it has {known}")
    if place.suffix in SUFFIXES:
        other = recorded_report(place, folder.contract, report.task)
    else:
        task = report.task if place.stem not in names else None
        other = read_attempt([place], folder.contract, folder.rehearsals, folder.watches, task, drawn)
    return replace(report, comparison=compare(report, other, place.as_posix()))


def _rehearsed(folder: GeneratedFolder, name: str, drawn: Drawn) -> Report:
    cell = cell_of(folder)
    with temporary_folder("cellc-rehearsal-") as place:
        bag = place / f"{name}.mcap"
        with open_new(bag) as file:
            recorded(cell, cell.entry(name), file, 0)
        return read_attempt([bag], folder.contract, folder.rehearsals, folder.watches, name, drawn)
