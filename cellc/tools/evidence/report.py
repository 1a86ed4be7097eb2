"""What a folder of evidence says of the gates of a package."""

from __future__ import annotations

from dataclasses import asdict

from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.frozen import dataclass
from cellc.contract.gates import GateEvidence, GateFile
from cellc.contract.vocabulary import GateCode, Term
from cellc.tools.evidence.folder import Unread


class Status(Term):
    """What is known of a file or a gate, as `scripts/observe` says it; people read notes, and sign."""

    PASSED = "PASSED"
    FAILED = "FAILED"
    UNKNOWN = "UNKNOWN"
    MISSING = "missing"
    TO_READ = "to be read"
    COMPLETE = "complete"


@dataclass(frozen=True, slots=True)
class Piece:
    """One file that a gate must leave.

    Attributes:
        paths: where it was found in the folder; the newest first.
        said: figures, or why it is not PASSED.
        attempts: ids of the runs that wrote it.
    """

    file: GateFile
    status: Status
    said: str
    paths: tuple[str, ...] = ()
    attempts: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Finding:
    """What a gate cannot be signed with."""

    status: Status
    text: str


@dataclass(frozen=True, slots=True)
class GateState:
    """One gate.

    Attributes:
        notes: what a person should know who signs.
        page: what a filled-in checklist reports of it, in words; empty without one.
        waits_for: gates before it that are not complete, each with its status.
    """

    evidence: GateEvidence
    pieces: tuple[Piece, ...]
    findings: tuple[Finding, ...]
    notes: tuple[str, ...] = ()
    page: str = ""
    waits_for: tuple[tuple[GateCode, Status], ...] = ()

    @property
    def status(self) -> Status:
        """FAILED where anything failed, UNKNOWN where anything is missing or not known, else complete."""
        found = {piece.status for piece in self.pieces} | {finding.status for finding in self.findings}
        if Status.FAILED in found:
            return Status.FAILED
        return Status.UNKNOWN if found & {Status.UNKNOWN, Status.MISSING} else Status.COMPLETE

    @property
    def missing(self) -> tuple[str, ...]:
        """What is not there."""
        return tuple(named(piece.file) for piece in self.pieces if piece.status is Status.MISSING)

    @property
    def said(self) -> str:
        """The status in words."""
        if self.status is not Status.COMPLETE:
            return str(self.status)
        first = ", ".join(f"{code} is {status}" for code, status in self.waits_for)
        signed = f"to be signed by the owner {self.evidence.signed_by}"
        return f"complete, but not to be signed yet: {first}" if first else f"complete, {signed}"

    @property
    def is_ready(self) -> bool:
        """Whether it is complete, and so is every gate before it."""
        return self.status is Status.COMPLETE and not self.waits_for


@dataclass(frozen=True, slots=True)
class Report:
    """All gates that were asked for.

    Attributes:
        folders: as the user named them.
        refused: evidence of another cell, configuration or host, each with what is another's.
        unread: what is in the folder and cannot be read.
        beside: files that no gate asks for.
    """

    folders: tuple[str, ...]
    cell: str
    summary: str
    configuration_id: str
    version_tuple: tuple[tuple[str, str], ...]
    hosts: tuple[str, ...]
    gates: tuple[GateState, ...]
    refused: tuple[Unread, ...]
    unread: tuple[Unread, ...]
    beside: tuple[str, ...]

    @property
    def complete(self) -> bool:
        """Whether all that was asked for is there and passed, after all before it, and nothing else is in the way."""
        return not self.refused and not self.unread and all(gate.is_ready for gate in self.gates)

    def numbers(self) -> tuple[tuple[Status, int, str], ...]:
        """Return how many gates have each status, with a word; complete ones that wait for others are apart."""
        ready, waiting = (
            sum(gate.status is Status.COMPLETE and gate.is_ready is each for gate in self.gates)
            for each in (True, False)
        )
        failed, unknown = (sum(gate.status is each for gate in self.gates) for each in (Status.FAILED, Status.UNKNOWN))
        apart = ((Status.UNKNOWN, waiting, "waiting for earlier gates"),) if waiting else ()
        counted = ((Status.FAILED, failed, str(Status.FAILED)), (Status.UNKNOWN, unknown, str(Status.UNKNOWN)))
        return ((Status.COMPLETE, ready, str(Status.COMPLETE)), *apart, *counted)


def named(file: GateFile) -> str:
    """Return the name of a file with its host, where it must be of one."""
    return file.name if file.host is None else f"{file.name} of {file.host}"


def to_json(report: Report) -> str:
    """Return the report for programs."""
    return json_document(
        {
            "format": 1,
            "cell": report.cell,
            "configuration_id": report.configuration_id,
            "folders": list(report.folders),
            "hosts": list(report.hosts),
            "complete": report.complete,
            "gates": [_gate(gate) for gate in report.gates],
            "refused": [asdict(each) for each in report.refused],
            "unread": [asdict(each) for each in report.unread],
            "beside": list(report.beside),
        }
    )


def _gate(gate: GateState) -> dict[str, object]:
    stated = gate.evidence
    return {
        "gate": stated.gate,
        "title": stated.title,
        "shows": stated.shows,
        "signed_by": stated.signed_by,
        "status": gate.status,
        "missing": list(gate.missing),
        "files": [_piece(piece) for piece in gate.pieces],
        "findings": [asdict(finding) for finding in gate.findings],
        "notes": list(gate.notes),
        "page": gate.page,
        "waits_for": [{"gate": code, "status": status} for code, status in gate.waits_for],
    }


def _piece(piece: Piece) -> dict[str, object]:
    return {
        "name": piece.file.name,
        "kind": piece.file.kind,
        "host": piece.file.host,
        "status": piece.status,
        "said": piece.said,
        "paths": list(piece.paths),
        "attempts": list(piece.attempts),
    }
