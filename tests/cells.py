"""The one way in which tests take a cell through the stages: document, cell, graph, findings, artifacts, folder.

A spec is a file of the repository or one that a test writes into a folder of its own. What is built of the cells of the
repository is built once per process and never changed.
"""

from __future__ import annotations

import json
import os
import re
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from cellc.compiler.artifact import Artifact
from cellc.compiler.catalog.compiled import compiled_device
from cellc.compiler.catalog.load import CatalogDevice, load_device
from cellc.compiler.cell.cell import Cell
from cellc.compiler.graph.cell_graph import CellGraph, build_graph
from cellc.compiler.link.link import link
from cellc.compiler.output.write import write
from cellc.compiler.pipeline import check, compile_cell
from cellc.compiler.rules.run import run_rules
from cellc.compiler.source import SourceDocument, read
from cellc.compiler.spec.parse import parse
from cellc.contract.diagnostics import Diagnostic, Outcome

ROOT = Path(__file__).resolve().parents[1]
CORPUS = ROOT / "tests" / "corpus"
COMPLETE = CORPUS / "valid" / "complete.yaml"
EVERY_CELL = tuple(sorted(path.parent.name for path in ROOT.glob("cells/*/cell.yaml")))
CELLS = EVERY_CELL if os.environ.get("CELLC_TEST_CELLS") == "every" else ("fr3_hand", "minimal", "ur5e_pick")
"""Cells that go through every test of each stage, for every distribution; the others go through the whole once."""
DISTROS = ("humble", "jazzy", "kilted", "lyrical")


_Value = TypeVar("_Value")


def there(value: _Value | None) -> _Value:
    """Return a value that a test needs to be there."""
    assert value is not None
    return value


@dataclass(frozen=True, slots=True)
class Compiled:
    """The artifacts of a cell, with the graph that they were written from."""

    graph: CellGraph
    artifacts: tuple[Artifact, ...]

    @property
    def texts(self) -> dict[str, str]:
        """The text of every file by its path in the package."""
        return {artifact.path: artifact.text for artifact in self.artifacts}


def spec_of(cell: str) -> Path:
    """Return the spec of a cell of the repository."""
    return ROOT / "cells" / cell / "cell.yaml"


def spec_text(cell: str) -> str:
    """Return the text of a spec of the repository."""
    return spec_of(cell).read_text(encoding="utf-8")


_ABSENT = dict.fromkeys(("kilted", "lyrical"), ("robot_state_broadcaster", "reset_fault"))


def without_absent(text: str, distro: str) -> str:
    """Return a spec without controllers of drivers that no distribution of that name has; each stands in one line."""
    for kind in _ABSENT.get(distro, ()):
        text = re.sub(rf"\n +\w+: {{type: {kind}, .*", "", text)
    return text


def written(folder: Path, text: str) -> Path:
    """Write a spec into a folder."""
    path = folder / "cell.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def catalog_facts(model: str) -> dict[str, Any]:
    """Return what the catalog says of a device, its family's file included, as plain data."""
    facts: dict[str, Any] = json.loads(there(compiled_device(model))[0])
    return facts


def device_of(model: str) -> CatalogDevice:
    """Return a device of the catalog."""
    return there(load_device(model).value)


def document_of(path: Path) -> SourceDocument:
    """Return what a legal YAML file says."""
    outcome = read(path)
    assert outcome.value is not None, outcome.diagnostics
    assert outcome.ok, outcome.diagnostics
    return outcome.value


def linking(path: Path) -> Outcome[Cell]:
    """Return the cell of a spec, with what the stages up to linking say of it."""
    source = read(path)
    if source.value is None or not source.ok:
        return Outcome(None, source.diagnostics)
    spec = parse(source.value)
    found = (*source.diagnostics, *spec.diagnostics)
    if spec.value is None or not spec.ok:
        return Outcome(None, found)
    cell = link(spec.value, source.value)
    return Outcome(cell.value, (*found, *cell.diagnostics))


def linked(path: Path) -> Cell:
    """Return the cell of a spec that reads, parses and links without a finding."""
    outcome = linking(path)
    assert outcome.diagnostics == ()
    assert outcome.value is not None
    return outcome.value


def graph_of(path: Path) -> CellGraph:
    """Return the graph of a spec that links without a finding."""
    return build_graph(linked(path))


def diagnose(path: Path) -> tuple[Diagnostic, ...]:
    """Return what every stage up to the rules says of a spec, and nothing taken out."""
    outcome = linking(path)
    if outcome.value is None or not outcome.ok:
        return outcome.diagnostics
    return (*outcome.diagnostics, *run_rules(build_graph(outcome.value)))


def compiled(path: Path) -> Compiled:
    """Return what is built of a spec without errors; a finding of a foreign parser fails the test."""
    checked = check(path)
    assert checked.graph is not None, [found.message for found in checked.diagnostics]
    outcome = compile_cell(checked)
    assert outcome.value is not None, [found.message for found in checked.diagnostics]
    assert outcome.diagnostics == (), [found.message for found in outcome.diagnostics]
    return Compiled(checked.graph, outcome.value)


def build_into(folder: Path, path: Path) -> Path:
    """Build a spec into a folder, and return the folder."""
    assert write(compiled(path).artifacts, folder).ok
    return folder


@cache
def built(cell: str) -> Compiled:
    """Return what is built of a cell of the repository."""
    return compiled(spec_of(cell))


@cache
def generated(cell: str) -> Path:
    """Return the folder that a cell of the repository is built into; a test that changes it takes a copy."""
    folder = Path(_generated_folders().name) / cell
    assert write(built(cell).artifacts, folder).ok
    return folder


@cache
def _generated_folders() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory()
