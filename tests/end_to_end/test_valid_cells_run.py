"""A cell without a finding comes up on the mock, and its rehearsals end as they should."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.mock import load
from cellc.output.write import write
from cellc.pipeline import check, compile_cell

CELLS = sorted((Path(__file__).resolve().parents[1] / "corpus" / "valid").glob("*.yaml"))
TOO_SHORT = {"equal_bounds"}
"""Cells whose goals may take no longer than an observation may be old: they time out, as their spec has it."""


@pytest.mark.parametrize("spec", CELLS, ids=lambda spec: spec.stem)
def test_rehearsals_of_a_valid_cell_pass(spec: Path, tmp_path: Path) -> None:
    compiled = compile_cell(check(spec))
    assert compiled.value is not None, compiled.diagnostics
    assert compiled.ok
    assert write(compiled.value, tmp_path / "cell").ok
    cell = load(tmp_path / "cell")
    ended = {name: cell.run(name, seed=0) for name in cell.rehearsals}
    failed = [f"{name}: {result.outcome}" for name, result in ended.items() if not result.passed]
    assert failed == ([f"{name}: timeout" for name in ended] if spec.stem in TOO_SHORT else [])
