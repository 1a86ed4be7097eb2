"""What a deployment says, subject by subject and step by step, against values written by hand from small specs.

``meaning.yaml`` has them: the rows of the lines of gates by their subject, and the steps of the bring-up as
``phase name: proof; proof -> request -> effect``. Nothing rewrites it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from cellc.compiler.deploy.bringup import bring_up
from cellc.compiler.deploy.gate_subjects import ROWS
from cellc.compiler.deploy.observation import observation
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.bring_up import BringUpStep
from tests.cells import CORPUS, ROOT, graph_of
from tests.foreign_yaml import safe_load

MEANT: dict[str, Any] = safe_load((Path(__file__).parent / "meaning.yaml").read_text(encoding="utf-8"))
ROWS_MEANT = [(spec, subject) for spec, told in MEANT.items() for subject in told.get("rows", ())]
STEPS_MEANT = [(spec, target) for spec, told in MEANT.items() for target in told.get("steps", ())]


@cache
def _graph(spec: str) -> CellGraph:
    folder = ROOT / "cells" / spec
    return graph_of(folder / "cell.yaml" if folder.is_dir() else CORPUS / "valid" / f"{spec}.yaml")


@pytest.mark.parametrize(("spec", "subject"), ROWS_MEANT)
def test_rows_of_a_subject(spec: str, subject: str) -> None:
    rows = [[str(value) for value in row] for row in ROWS[subject](_graph(spec))]
    assert rows == [list(map(str, row)) for row in MEANT[spec]["rows"][subject]]


@pytest.mark.parametrize("spec", [spec for spec, told in MEANT.items() if "observed" in told])
def test_what_an_observer_finds_on_the_real_target(spec: str) -> None:
    graph = _graph(spec)
    real = observation(graph, bring_up(graph.cell)).real
    found = {
        "component": [[name, state] for each in real.states.values() for name, state in each.hardware.items()],
        "managed_node": [[name, state] for name, state in real.lifecycle.items()],
        "interface": [[name, _told(ends.sources), _told(ends.sinks)] for name, ends in real.ends.items()],
    }
    meant = MEANT[spec]["observed"]
    assert {kind: found[kind] for kind in meant} == meant


def _told(side: Mapping[str, str]) -> str:
    return ", ".join(f"{node} (from {gate} on)" if gate else node for node, gate in side.items()) or "none"


def test_other_subjects_of_the_complete_cell_are_empty() -> None:
    empty = [subject for subject, rows in ROWS.items() if not list(rows(_graph("complete")))]
    assert set(empty) == set(ROWS) - set(MEANT["complete"]["rows"])


@pytest.mark.parametrize(("spec", "target"), STEPS_MEANT)
def test_steps_of_the_bring_up(spec: str, target: str) -> None:
    steps = bring_up(_graph(spec).cell).proven_steps("mock" if target == "mock" else "real")
    assert [_line(step) for step in steps] == MEANT[spec]["steps"][target]


@pytest.mark.parametrize("spec", [spec for spec, told in MEANT.items() if "watches" in told])
def test_watches(spec: str) -> None:
    watches = [watch.model_dump(mode="json", exclude_defaults=True) for watch in bring_up(_graph(spec).cell).watches]
    assert watches == MEANT[spec]["watches"]


def _line(step: BringUpStep) -> str:
    told = step.model_dump(mode="json", exclude_defaults=True)
    where = f" on {step.host}" if step.host else ""
    parts = [
        "; ".join(map(_words, told["proof"])),
        _words(told.get("request", {})),
        "; ".join(map(_words, told.get("effect", ()))),
    ]
    return f"{told['phase']} {step.name}{where}: " + " -> ".join(part for part in parts if part)


def _words(told: Mapping[str, Any]) -> str:
    values = (value for value in told.values() if value is not None)
    return " ".join(",".join(map(str, value)) if isinstance(value, list) else str(value) for value in values)
