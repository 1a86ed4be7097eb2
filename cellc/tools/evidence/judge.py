"""From sorted evidence to the state of each gate."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

from cellc.contract.diagnostics.wording import count
from cellc.contract.gates import GateEvidence, GateFile
from cellc.contract.vocabulary import GateCode
from cellc.tools.evidence.checklist import Section
from cellc.tools.evidence.folder import EvidenceError, Item, metadata_of
from cellc.tools.evidence.join import FAILED, PASSED, joined, responsible
from cellc.tools.evidence.records import UNKNOWN, AttemptRecord, FirstGoalRecord, ObserveRecord
from cellc.tools.evidence.report import Finding, GateState, Piece, Status
from cellc.tools.evidence.runs import of_runs
from cellc.tools.evidence.sort import Package, Sorted, records_of

_SHOWN = 20
"""Findings of one kind that a gate names; the others are counted."""
_VERDICT = re.compile(r"^[ \t]*(passed|PASSED|FAILED|failed(?=[ \t]{2}))[ \t]+(\S[^\n]*)$", re.MULTILINE)
"""As programs print them; `failed` behind a single blank is prose."""
_MESSAGES = re.compile(r"^  message_count: (\d{1,18})$", re.MULTILINE)


def judged(gate: GateEvidence, package: Package, found: Sorted) -> GateState:
    """Return the state of one gate."""
    if not gate.files:
        closed = "must not be passed: nothing of the catalog moves this cell on the real target"
        return GateState(gate, (), (Finding(Status.UNKNOWN, closed),))
    pieces = tuple(_piece(file, gate, package, found) for file in gate.files)
    compared = list(_lines(gate, package, found))
    findings = [*compared, *_noted(gate, package, found, compared), *_broken(pieces, found)]
    notes = list(_earlier(gate, found))
    if gate.gate is GateCode.G0:
        notes += _deviations(found)
        findings += _unknown(package.unknown)
    if gate.gate is GateCode.G2:
        of_mock, said = of_runs(found.indices)
        findings, notes = [*findings, *of_mock], [*notes, *said]
    page, open_ = _filled(found.pages.get(gate.gate, ()), gate.gate, package.pages.get(gate.gate))
    return GateState(gate, pieces, (*_some(findings), *open_), tuple(notes), page)


def is_started(gate: GateEvidence, found: Sorted) -> bool:
    """Return whether a folder has anything of a gate: evidence, or a line of its checklist that is filled in."""
    names = {file.name for file in gate.files}
    if gate.gate is GateCode.G2 and found.indices:
        return True
    there = (found.notes, found.records, found.bags, found.broken)
    return any(names & kind.keys() for kind in there) or any(
        section.is_started for _, section in found.pages.get(gate.gate, ())
    )


def _some(findings: list[Finding]) -> Iterator[Finding]:
    for status in (Status.FAILED, Status.UNKNOWN):
        those = [finding for finding in findings if finding.status is status]
        yield from those[:_SHOWN]
        if len(those) > _SHOWN:
            yield Finding(status, f"and {len(those) - _SHOWN} more")


def _piece(file: GateFile, gate: GateEvidence, package: Package, found: Sorted) -> Piece:
    broken = found.broken.get(file.name, ())
    kinds: Mapping[str, Callable[[GateFile, Sorted], Piece]] = {
        "notes": _notes,
        "bag": _bag,
        "observe": partial(_observed, package),
        "first_goal": _goal,
    }
    piece = kinds.get(file.kind, _attempt)(file, found)
    if not broken or piece.status is not Status.MISSING:
        return piece
    return Piece(file, Status.UNKNOWN, broken[0].why, tuple(each.path for each in broken))


def _notes(file: GateFile, found: Sorted) -> Piece:
    texts = found.notes.get(file.name, ())
    paths = tuple(item.path for item, _, _ in texts)
    if not texts:
        return Piece(file, Status.MISSING, "")
    if not any(text.strip() for _, text, _ in texts):
        return Piece(file, Status.UNKNOWN, "is empty", paths)
    return Piece(file, Status.TO_READ, count(sum(len(text.splitlines()) for _, text, _ in texts), "line"), paths)


def _bag(file: GateFile, found: Sorted) -> Piece:
    bags = found.bags.get(file.name, ())
    paths = tuple(item.path for item in bags)
    if not bags:
        return Piece(file, Status.MISSING, "")
    try:
        numbers = [_messages(item) for item in bags]
    except EvidenceError as error:
        return Piece(file, Status.UNKNOWN, str(error), paths)
    said = ", ".join(count(number, "message") for number in numbers)
    return Piece(file, Status.TO_READ if all(numbers) else Status.UNKNOWN, said, paths)


def _messages(bag: Item) -> int:
    stated = _MESSAGES.search(metadata_of(bag))
    return 0 if stated is None else int(stated[1])


def _observed(package: Package, file: GateFile, found: Sorted) -> Piece:
    reports = [(item, record) for item, record in records_of(found, file) if isinstance(record, ObserveRecord)]
    if not reports:
        return Piece(file, Status.MISSING, "")
    newest, least_s = reports[0][1], file.least_s or 0.0
    hosts = tuple(package.plan.hosts)
    mine = ((line, responsible(line.part, line.subject, package.plan, hosts)) for line in newest.lines)
    own = [line for line, of in mine if file.host is None or file.host in of]
    said = f"{newest.host or 'host not named'}, {newest.seconds:.0f} s, {count(len(newest.lines), 'line')}"
    verdicts = {line.verdict for line in own}
    status = Status.FAILED if FAILED in verdicts else Status.UNKNOWN if UNKNOWN in verdicts else Status.PASSED
    if not newest.lines:
        status, said = Status.UNKNOWN, f"{said}: nothing was compared"
    elif newest.seconds < least_s * 0.99:
        said = f"{said}; {least_s:.0f} s must be observed"
        status = Status.FAILED if status is Status.FAILED else Status.UNKNOWN
    return Piece(file, status, said, tuple(item.path for item, _ in reports), _ids(reports))


def _ids(reports: list[tuple[Item, ObserveRecord]]) -> tuple[str, ...]:
    return tuple(record.attempt_id for _, record in reports)


def _goal(file: GateFile, found: Sorted) -> Piece:
    goals = [(item, record) for item, record in records_of(found, file) if isinstance(record, FirstGoalRecord)]
    if not goals:
        return Piece(file, Status.MISSING, "")
    paths, ids = tuple(item.path for item, _ in goals), tuple(record.attempt_id for _, record in goals)
    newest = goals[0][1]
    if newest.verdict == FAILED:
        return Piece(file, Status.FAILED, newest.seen, paths, ids)
    if newest.configuration_id is None:
        return Piece(file, Status.UNKNOWN, "names no configuration: it was started without --package", paths, ids)
    return Piece(file, Status.PASSED, "every goal ended as requested", paths, ids)


def _attempt(file: GateFile, found: Sorted) -> Piece:
    records = [(item, record) for item, record in records_of(found, file) if isinstance(record, AttemptRecord)]
    if not records:
        return Piece(file, Status.MISSING, "")
    known = records[0][1].outcome != UNKNOWN
    said = f"outcome {records[0][1].outcome}"
    return Piece(file, Status.TO_READ if known else Status.UNKNOWN, said, tuple(item.path for item, _ in records))


def _lines(gate: GateEvidence, package: Package, found: Sorted) -> Iterator[Finding]:
    """Yield each comparison that did not pass, over the newest report of each host."""
    newest: dict[str, ObserveRecord] = {}
    for file in gate.files:
        for _, record in records_of(found, file):
            if isinstance(record, ObserveRecord):
                newest.setdefault(record.host, record)
    for line in joined(newest, package.plan):
        if line.verdict != PASSED and line.seen:
            word = "contradicted, " if line.contradicted else ""
            yield Finding(Status(line.verdict), f"{line.subject}: {word}{line.seen} (expected: {line.expected})")


def _noted(gate: GateEvidence, package: Package, found: Sorted, compared: Sequence[Finding]) -> Iterator[Finding]:
    """Yield what notes say that a person must not sign over, but for what is found in the report of a program too."""
    own = package.identity.configuration_id
    for file in gate.files:
        texts = found.notes.get(file.name, ())
        for item, text, others in texts:
            last: dict[str, str] = {}
            for said in _VERDICT.finditer(text):
                last[said[2].partition(": ")[0].strip()] = said[1].upper()
            failed = [
                subject
                for subject, verdict in last.items()
                if verdict == FAILED and not any(line.text.startswith(_of_line(subject)) for line in compared)
            ]
            yield from (Finding(Status.FAILED, f"{item.path} says FAILED of {subject}") for subject in failed)
            yield from (Finding(Status.UNKNOWN, f"{item.path} also names configuration {each}") for each in others)
        if gate.gate is GateCode.G0 and texts and not any(own is not None and own in text for _, text, _ in texts):
            yield Finding(Status.UNKNOWN, f"{file.name} does not have the configuration ID {own}")


def _of_line(subject: str) -> str:
    """Return the subject of a printed comparison as its finding begins, without the part of the graph before it."""
    return f"{subject.partition(' ')[2].strip() or subject}: "


def _broken(pieces: tuple[Piece, ...], found: Sorted) -> Iterator[Finding]:
    """Yield what cannot be read beside what can."""
    there = dict.fromkeys(path for piece in pieces for path in piece.paths)
    for name in dict.fromkeys(piece.file.name for piece in pieces):
        those = (each for each in found.broken.get(name, ()) if each.path not in there)
        yield from (Finding(Status.UNKNOWN, f"{each.path}: {each.why}") for each in those)


def _earlier(gate: GateEvidence, found: Sorted) -> Iterator[str]:
    """Yield which reports were followed by a newer one of the same host."""
    seen: set[str] = set()
    for name in dict.fromkeys(file.name for file in gate.files if file.kind == "observe"):
        for item, record in records_of(found, GateFile(name=name, kind="observe")):
            if isinstance(record, ObserveRecord) and record.host in seen:
                failed = sum(line.verdict == FAILED for line in record.lines)
                yield f"{item.path} is an earlier run, in which {count(failed, 'line')} failed"
            elif isinstance(record, ObserveRecord):
                seen.add(record.host)


def _unknown(parts: Sequence[str]) -> Iterator[Finding]:
    if parts:
        those = f"{count(len(parts), 'part')} of the version tuple UNKNOWN: {', '.join(parts)}"
        yield Finding(Status.UNKNOWN, f"{those}; enter them in the spec and build again")


def _deviations(found: Sorted) -> Iterator[str]:
    for item, text in found.deviations:
        lines = [line for line in text.splitlines() if line.strip()]
        yield from (f"{item.path}: {line}" for line in lines[:_SHOWN])
        if len(lines) > _SHOWN:
            yield f"{item.path}: and {len(lines) - _SHOWN} more"


def _filled(
    copies: Sequence[tuple[str, Section]], gate: str, printed: Section | None
) -> tuple[str, tuple[Finding, ...]]:
    """Return what the last copy of the checklist says of a gate, in words, and what is open in it."""
    if not copies:
        lines = count(0 if printed is None else len(printed.boxes), "line")
        page = "network.md" if gate.startswith("L") else "promotion.md"
        return "", (Finding(Status.UNKNOWN, f"no copy of gates/{page} with {lines} ticked"),)
    path, section = copies[-1]
    ticked, apart = (sum(mark == each for _, mark in section.boxes) for each in ("x", "-"))
    signed = ", ".join(text for text in (section.result, section.name, section.date) if text)
    beside = f", {apart} do not apply" if apart else ""
    said = f"{path}: {ticked} of {count(len(section.boxes), 'line')} ticked{beside}; result: {signed or 'blank'}"
    findings = list[Finding]()
    bare = () if printed is None else section.without_reason(printed)
    if bare:
        those = f"{count(len(bare), 'line')} marked as not applying without a reason behind, first: {bare[0]}"
        findings.append(Finding(Status.UNKNOWN, f"{path}: {those}"))
    if section.open:
        findings.append(
            Finding(Status.UNKNOWN, f"{path}: {count(len(section.open), 'line')} not ticked, first: {section.open[0]}")
        )
    if section.result.lower().startswith(("stop", "fail")):
        findings.append(Finding(Status.FAILED, f"{path}: result: {section.result}"))
    return said, tuple(findings)
