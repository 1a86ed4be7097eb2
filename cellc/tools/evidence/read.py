"""From folders of evidence and a generated package to the report."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from cellc.contract.contract import Contract
from cellc.contract.file_names import is_cell_name
from cellc.contract.gates import GateEvidence
from cellc.contract.observation import Observation
from cellc.contract.printing import stage
from cellc.contract.reading import FormatError, read_json
from cellc.contract.vocabulary import GATE_ORDER, GateCode
from cellc.mock.errors import MockError
from cellc.mock.folder import read_folder, read_text
from cellc.tools.evidence.checklist import PAGES, Section, sections_of
from cellc.tools.evidence.folder import EvidenceError, Item, Unread, listed
from cellc.tools.evidence.judge import is_started, judged
from cellc.tools.evidence.records import UNKNOWN, Identity, Named
from cellc.tools.evidence.report import GateState, Report, Status
from cellc.tools.evidence.sort import Package, Sorted, sort

_OBSERVATION = "config/observe.json"
_OWN = (".evidence.json", ".evidence.html")
"""Ends of the names that `cellc evidence -o` gives to its own files."""


def report_of(folders: Sequence[Path], generated: Path, codes: Collection[GateCode] = ()) -> Report:
    """Return what folders of evidence say of the gates of a package.

    Args:
        folders: in the order of their attempts. Of a gate the last one counts that has anything of it.
        codes: gates that are asked for; all of the package if empty.

    Raises:
        EvidenceError: a folder is not one, or the package states no evidence.
        MockError: the package is not as it was generated.
    """
    contract, package = package_of(generated)
    bags = {file.name for gate in package.gates for file in gate.files if file.kind == "bag"}
    own = {f"{contract.cell}{ending}" for ending in _OWN}
    attempts, unread = list[Sorted](), list[Unread]()
    for folder in folders:
        stage(f"reading {folder.name}")
        above = "" if len(folders) == 1 else f"{folder.as_posix().rstrip('/')}/"
        items, ill = listed(folder, bags)
        unread += (Unread(f"{above}{each.path}", each.why) for each in ill)
        attempts.append(
            sort([replace(item, path=f"{above}{item.path}") for item in items if item.path not in own], package)
        )
    states = _in_order([judged(gate, package, _last(gate, attempts)) for gate in package.gates])
    return Report(
        folders=tuple(folder.as_posix() for folder in folders),
        cell=contract.cell,
        summary=contract.summary,
        configuration_id=contract.configuration_id,
        version_tuple=tuple(contract.version_tuple.items()),
        hosts=tuple(package.plan.hosts),
        gates=tuple(state for state in states if not codes or state.evidence.gate in codes),
        refused=tuple(each for found in attempts for each in found.refused),
        unread=(*unread, *(each for found in attempts for each in found.unread)),
        beside=tuple(each for found in attempts for each in found.beside),
    )


def _last(gate: GateEvidence, attempts: Sequence[Sorted]) -> Sorted:
    """Return the last attempt that has anything of a gate."""
    return next((found for found in reversed(attempts) if is_started(gate, found)), attempts[-1])


def _in_order(states: Sequence[GateState]) -> Iterator[GateState]:
    """Yield the states as gates are passed, with the gates before each that are not complete."""
    open_ = {state.evidence.gate: state.status for state in states if state.status is not Status.COMPLETE}
    for state in sorted(states, key=lambda state: GATE_ORDER.index(state.evidence.gate)):
        before = GATE_ORDER[: GATE_ORDER.index(state.evidence.gate)]
        yield replace(state, waits_for=tuple((code, open_[code]) for code in before if code in open_))


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


def cell_of(folders: Sequence[Path]) -> str:
    """Return the cell that the records of folders name.

    Raises:
        EvidenceError: one is no folder, or the records name no cell, or several.
    """
    items = [item for folder in folders for item in listed(folder, ())[0]]
    names = {name for item in items if item.name.endswith(".json") and (name := _named(item))}
    if len(names) == 1:
        return names.pop()
    those = ", ".join(folder.as_posix() for folder in folders)
    said = f"names several cells, {', '.join(sorted(names))}" if names else "does not name its cell"
    raise EvidenceError(f"{those}: {said}; name the generated folder with --package")


def _named(item: Item) -> str:
    try:
        cell = item.record(Named).cell
    except EvidenceError:
        return ""
    return cell if is_cell_name(cell) else ""
