"""Sorts what a folder holds by the gates that ask for it: own evidence by kind, and what is refused, each with why."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field

from cellc.contract.frozen import dataclass
from cellc.contract.gates import GateEvidence, GateFile
from cellc.contract.observation import ObservedTarget
from cellc.tools.evidence.checklist import Section, sections_of
from cellc.tools.evidence.folder import EvidenceError, Item, Unread
from cellc.tools.evidence.records import (
    AttemptRecord,
    FirstGoalRecord,
    Identity,
    ObserveRecord,
    RunsIndex,
    said_in,
)

INDEX, DEVIATIONS = "evidence.json", "versions.txt"
_TIME = r"\d{8}T\d{6}Z"
Record = ObserveRecord | FirstGoalRecord | AttemptRecord
_Model = type[ObserveRecord] | type[FirstGoalRecord] | type[AttemptRecord]
_MODELS: Mapping[str, _Model] = {
    "observe": ObserveRecord,
    "first_goal": FirstGoalRecord,
    "attempt": AttemptRecord,
}


@dataclass(frozen=True, slots=True)
class Package:
    """What the generated folder states.

    Attributes:
        pages: sections of both checklists, by gate.
        unknown: parts of the version tuple that are UNKNOWN.
    """

    identity: Identity
    gates: tuple[GateEvidence, ...]
    plan: ObservedTarget
    pages: Mapping[str, Section]
    unknown: tuple[str, ...] = ()


@dataclass(slots=True)
class Sorted:
    """Evidence of this package; items are in the order of their paths.

    Attributes:
        notes: by name, with the text and the configurations of others that it names too.
        records: observations, first goals and attempts, by the name that a gate gives them.
        broken: by the same names, what is there and cannot be read, each with why.
        pages: by gate, the filled-in section of each copy, with its path.
    """

    notes: dict[str, list[tuple[Item, str, tuple[str, ...]]]] = field(default_factory=dict)
    records: dict[str, list[tuple[Item, Record]]] = field(default_factory=dict)
    bags: dict[str, list[Item]] = field(default_factory=dict)
    broken: dict[str, list[Unread]] = field(default_factory=dict)
    indices: list[tuple[Item, RunsIndex]] = field(default_factory=list)
    deviations: list[tuple[Item, str]] = field(default_factory=list)
    pages: dict[str, list[tuple[str, Section]]] = field(default_factory=dict)
    refused: list[Unread] = field(default_factory=list)
    unread: list[Unread] = field(default_factory=list)
    beside: list[str] = field(default_factory=list)


def sort(items: Sequence[Item], package: Package) -> Sorted:
    """Read each item by what its name says that it is."""
    found = Sorted()
    files = {file.name: file for gate in package.gates for file in gate.files}
    stems = {item.path.rpartition(".")[0] for item in items if item.name.endswith(".json")}
    for item in items:
        file = next((file for name, file in files.items() if matches(item.name, name)), None)
        try:
            if file is not None:
                _asked(item, file, package, found)
            elif not _further(item, package, found) and item.path.rpartition(".")[0] not in stems:
                found.beside.append(item.path)
        except EvidenceError as error:
            problem = Unread(item.path, str(error))
            (found.unread if file is None else found.broken.setdefault(file.name, [])).append(problem)
    return found


def matches(name: str, pattern: str) -> bool:
    """Whether a file has the name that a gate gives it; `*` there is a time of writing."""
    return re.fullmatch(re.escape(pattern).replace(r"\*", _TIME), name) is not None


def _asked(item: Item, file: GateFile, package: Package, found: Sorted) -> None:
    if file.kind == "bag":
        if not item.is_bag:
            raise EvidenceError("must be the folder of a recording")
        found.bags.setdefault(file.name, []).append(item)
    elif item.is_bag:
        raise EvidenceError("must be a file")
    elif file.kind == "notes":
        text = item.text()
        identity, others = said_in(text, package.identity)
        if _is_own(item, identity, package, found):
            found.notes.setdefault(file.name, []).append((item, text, others))
    else:
        record = item.record(_MODELS[file.kind])
        problem = _misnamed(item, file, record, package)
        if problem:
            found.refused.append(Unread(item.path, problem))
        elif _is_own(item, Identity(record.cell, record.configuration_id), package, found):
            found.records.setdefault(file.name, []).append((item, record))


def _misnamed(item: Item, file: GateFile, record: Record, package: Package) -> str:
    """Return why a record is not what its name says; empty where it is."""
    if isinstance(record, FirstGoalRecord):
        name = f"G7-first-goal-{record.joint}-{record.then}-{record.attempt_id}.json"
        return "" if item.name == name else f"says to be {name}: it was renamed"
    if not isinstance(record, ObserveRecord):
        return ""
    name = f"observe-{record.gate}-{record.attempt_id}.json"
    if item.name != name:
        return f"says to be {name}: it was renamed"
    if record.target != "real":
        return f"observes the mock; {record.gate} is passed on the real target"
    hosts = package.plan.hosts
    return "" if not hosts or record.host in hosts else f"is of host `{record.host}`, expected {' or '.join(hosts)}"


def _is_own(item: Item, identity: Identity, package: Package, found: Sorted) -> bool:
    differs = identity.differs_from(package.identity)
    if differs:
        found.refused.append(Unread(item.path, differs))
    return not differs


def _further(item: Item, package: Package, found: Sorted) -> bool:
    """Take what no gate must leave and what says something of one all the same."""
    if item.is_bag:
        return False
    if item.name == INDEX:
        index = item.record(RunsIndex)
        if _is_own(item, Identity(index.cell, index.configuration_id), package, found):
            found.indices.append((item, index))
    elif item.name == DEVIATIONS:
        found.deviations.append((item, item.text()))
    elif item.name in ("promotion.md", "network.md"):
        _page(item, package, found)
    else:
        return False
    return True


def _page(item: Item, package: Package, found: Sorted) -> None:
    for code, section in sections_of(item.text()).items():
        own = package.pages.get(code)
        if own is None or not section.is_copy_of(own):
            found.refused.append(Unread(item.path, f"is no copy of gates/{item.name} of this package: {code} differs"))
            return
        found.pages.setdefault(code, []).append((item.path, section))


def records_of(found: Sorted, file: GateFile) -> Iterator[tuple[Item, Record]]:
    """Yield what a gate asks for, the newest first; of the host alone that must leave it."""
    newest = sorted(found.records.get(file.name, ()), key=lambda each: each[0].name, reverse=True)
    for item, record in newest:
        if file.host is None or not isinstance(record, ObserveRecord) or record.host == file.host:
            yield item, record
