"""Rehearsals of the mock in a folder of evidence: each file is as the index has it, and each run ended as expected."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from cellc.contract.errors import reason_of
from cellc.contract.file_names import is_file_name
from cellc.contract.limits import limits, option
from cellc.contract.store.regular_file import open_regular
from cellc.tools.evidence.folder import EvidenceError, Item
from cellc.tools.evidence.records import RunFigures, RunsIndex
from cellc.tools.evidence.report import Finding, Status

_PIECE = 1 << 20
_FIGURES = ".kpis.json"


def of_runs(indices: Sequence[tuple[Item, RunsIndex]]) -> tuple[list[Finding], list[str]]:
    """Return what gate G2 cannot be signed with, and what there is."""
    findings, notes = list[Finding](), list[str]()
    for item, index in indices:
        try:
            _hold(item, index)
            runs = [_beside(item, name).record(RunFigures) for name in index.files if name.endswith(_FIGURES)]
        except EvidenceError as error:
            findings.append(Finding(Status.UNKNOWN, f"{item.path}: {error}"))
            continue
        ill = [run for run in runs if not run.passed]
        findings += [
            Finding(Status.FAILED, f"rehearsal {run.rehearsal} ended in {run.outcome}: {item.path}") for run in ill
        ]
        if runs:
            notes.append(f"{len(runs) - len(ill)} of {len(runs)} rehearsals ended as expected: {item.path}")
    return findings, notes


def _beside(index: Item, name: str) -> Item:
    return Item(f"{index.path.rpartition('/')[0]}/{name}".lstrip("/"), index.place.with_name(name))


def _hold(item: Item, index: RunsIndex) -> None:
    """Raise EvidenceError where a file is not as the index has it; bytes are read up to the bound of a folder."""
    left = limits().folder_total_bytes
    for name, sha256 in index.files.items():
        if not is_file_name(name):
            raise EvidenceError("names a file outside of its folder")
        try:
            digest, size = _digest(_beside(item, name), left)
        except OSError as error:
            raise EvidenceError(f"`{name}` cannot be read: {reason_of(error)}") from None
        left -= size
        if digest != sha256:
            raise EvidenceError(f"`{name}` is not as cellc wrote it")


def _digest(file: Item, most: int) -> tuple[str, int]:
    digest, size = hashlib.sha256(), 0
    with open_regular(file.place, follow=False) as stream:
        while piece := stream.read(_PIECE):
            size += len(piece)
            if size > most:
                raise EvidenceError(f"exceeds what is read of a folder; {option('folder-total-bytes')}")
            digest.update(piece)
    return digest.hexdigest(), size
