"""Link a cell of the repository, or one that a test writes."""

from __future__ import annotations

from pathlib import Path

from cellc.cell.cell import Cell
from cellc.link.link import link
from cellc.source import read
from cellc.spec.parse import parse

ROOT = Path(__file__).resolve().parents[2]


def linked(path: Path) -> Cell:
    """Return the cell of a spec that reads, parses and links without a finding."""
    document = read(path)
    assert document.diagnostics == ()
    assert document.value is not None
    spec = parse(document.value)
    assert spec.diagnostics == ()
    assert spec.value is not None
    cell = link(spec.value, document.value)
    assert cell.diagnostics == ()
    assert cell.value is not None
    return cell.value


def linked_text(text: str, folder: Path) -> Cell:
    """Return the cell of a text."""
    path = folder / "cell.yaml"
    path.write_text(text, encoding="utf-8")
    return linked(path)
