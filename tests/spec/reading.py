"""Read a spec that a test writes, and a small one to change."""

from __future__ import annotations

import json
from pathlib import Path

from cellc.compiler.source import Plain, read
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.parse import parse
from cellc.contract.diagnostics import Outcome
from tests.cells import ROOT, there

CELLS = sorted(ROOT.glob("cells/*/cell.yaml"))

HEAD = """\
format: 1
cell: small
versions: {ros: jazzy}
"""
ARM = "devices: {arm: {model: ur5e}}\n"


def document_of(text: str, folder: Path) -> SourceDocument:
    """Return the document of a spec; what the text says must be legal YAML."""
    path = folder / "cell.yaml"
    path.write_text(text, encoding="utf-8")
    outcome = read(path)
    assert outcome.ok, outcome.diagnostics
    return there(outcome.value)


def parsed(text: str, folder: Path) -> Outcome[CellSpec]:
    """Return what the spec stage says of a text."""
    return parse(document_of(text, folder))


def as_yaml(data: Plain) -> str:
    return json.dumps(data, ensure_ascii=False)
