"""Short ways to read a spec in a test."""

from __future__ import annotations

from pathlib import Path

from cellc.compiler.source import SourceDocument, read
from cellc.contract.diagnostics import Outcome
from tests.cells import there


def read_bytes(folder: Path, content: bytes | str) -> Outcome[SourceDocument]:
    path = folder / "cell.yaml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read(path)


def codes(outcome: Outcome[SourceDocument]) -> list[str]:
    return [diagnostic.code for diagnostic in outcome.diagnostics]


def places(outcome: Outcome[SourceDocument]) -> list[tuple[str, int, int]]:
    return [(found.code, found.span.line, found.span.column) for found in outcome.diagnostics]


def document(folder: Path, content: bytes | str) -> SourceDocument:
    outcome = read_bytes(folder, content)
    assert outcome.ok, outcome.diagnostics
    return there(outcome.value)
