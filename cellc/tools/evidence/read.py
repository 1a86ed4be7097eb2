"""From a folder of evidence and a generated package to the report."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from cellc.contract.contract import Contract
from cellc.contract.file_names import is_cell_name
from cellc.contract.observation import Observation
from cellc.contract.printing import stage
from cellc.contract.reading import FormatError, read_json
from cellc.contract.vocabulary import GateCode
from cellc.mock.errors import MockError
from cellc.mock.folder import read_folder, read_text
from cellc.tools.evidence.checklist import PAGES, Section, sections_of
from cellc.tools.evidence.folder import EvidenceError, Item, listed
from cellc.tools.evidence.judge import judged
from cellc.tools.evidence.records import UNKNOWN, Identity, Named
from cellc.tools.evidence.report import Report
from cellc.tools.evidence.sort import Package, sort

_OBSERVATION = "config/observe.json"
_OWN = (".evidence.json", ".evidence.html")
"""Ends of the names that `cellc evidence -o` gives to its own files."""


def report_of(folder: Path, generated: Path, codes: Collection[GateCode] = ()) -> Report:
    """Return what a folder of evidence says of the gates of a package.

    Args:
        codes: gates that are asked for; all of the package if empty.

    Raises:
        EvidenceError: a folder is not one, or the package states no evidence.
        MockError: the package is not as it was generated.
    """
    stage(f"reading {folder.name}")
    contract, package = package_of(generated)
    bags = {file.name for gate in package.gates for file in gate.files if file.kind == "bag"}
    items, unread = listed(folder, bags)
    own = {f"{contract.cell}{ending}" for ending in _OWN}
    found = sort([item for item in items if item.path not in own], package)
    asked = [gate for gate in package.gates if not codes or gate.gate in codes]
    return Report(
        folder=folder.as_posix(),
        cell=contract.cell,
        summary=contract.summary,
        configuration_id=contract.configuration_id,
        version_tuple=tuple(contract.version_tuple.items()),
        hosts=tuple(package.plan.hosts),
        gates=tuple(judged(gate, package, found) for gate in asked),
        refused=tuple(found.refused),
        unread=(*unread, *found.unread),
        beside=tuple(found.beside),
    )


def package_of(folder: Path) -> tuple[Contract, Package]:
    """Return what a generated folder states of its evidence; raises as `report_of`."""
    contract = read_folder(folder).contract
    if contract.gates is None or not contract.gates.evidence or not (folder / _OBSERVATION).exists():
        raise EvidenceError(f"{folder.as_posix()}: an older cellc built it, which states no evidence; build it again")
    try:
        plan = read_json(read_text(folder, _OBSERVATION), Observation).real
    except FormatError as error:
        raise MockError(_OBSERVATION, str(error)) from None
    pages: dict[str, Section] = {}
    for page in PAGES:
        pages.update(sections_of(read_text(folder, page)))
    identity = Identity(contract.cell, contract.configuration_id)
    unknown = tuple(part for part, version in contract.version_tuple.items() if version == UNKNOWN)
    return contract, Package(identity, contract.gates.evidence, plan, pages, unknown)


def cell_of(folder: Path) -> str:
    """Return the cell that the records of a folder name.

    Raises:
        EvidenceError: it is no folder, or its records name none, or several.
    """
    items, _ = listed(folder, ())
    names = {name for item in items if item.name.endswith(".json") and (name := _named(item))}
    if len(names) == 1:
        return names.pop()
    said = f"names several cells, {', '.join(sorted(names))}" if names else "does not name its cell"
    raise EvidenceError(f"{folder.as_posix()}: {said}; name the generated folder with --package")


def _named(item: Item) -> str:
    try:
        cell = item.record(Named).cell
    except EvidenceError:
        return ""
    return cell if is_cell_name(cell) else ""
