"""A cell without a finding comes up on the mock, and its rehearsals end as they should."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.mock import load
from tests.cells import CORPUS, build_into

CELLS = sorted((CORPUS / "valid").glob("*.yaml"))


@pytest.mark.parametrize("spec", CELLS, ids=lambda spec: spec.stem)
def test_rehearsals_of_a_valid_cell_pass(spec: Path, tmp_path: Path) -> None:
    cell = load(build_into(tmp_path / "cell", spec))
    ended = {name: cell.run(name, seed=0) for name in cell.rehearsals}
    assert not [f"{name}: {result.outcome}" for name, result in ended.items() if not result.passed]
