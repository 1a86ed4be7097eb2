"""A cell without a finding comes up on the mock, and its rehearsals end as they should.

A session takes one cell of three; with ``--long`` every one is taken.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.mock import load
from tests.cells import CORPUS, build_into
from tests.sample import sample

_SHARE = 3
CELLS = sorted((CORPUS / "valid").glob("*.yaml"))


def test_rehearsals_of_valid_cells_pass(request: pytest.FixtureRequest, tmp_path: Path) -> None:
    failed = list[str]()
    for spec in sample(request, CELLS, _SHARE, lambda spec: spec.stem):
        cell = load(build_into(tmp_path / spec.stem, spec))
        ended = {name: cell.run(name, seed=0) for name in cell.rehearsals}
        failed += [f"{spec.stem}, {name}: {result.outcome}" for name, result in ended.items() if not result.passed]
    assert failed == []
