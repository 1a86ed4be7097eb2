"""No change of a cell's text or structure ends in a traceback, or takes long."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from tests.cells import CELLS, spec_text
from tests.robustness.mutations import mutated

SEEDS = range(15)  # benchmarks/mutated_cells.py takes thousands
LONGEST_S = 10.0  # on the processor: far above what a check takes, far below what a hang does


@pytest.mark.parametrize("cell", CELLS)
def test_mutated_cell_is_diagnosed(cell: str, tmp_path: Path) -> None:
    text = spec_text(cell)
    for seed in SEEDS:
        file = tmp_path / "cell.yaml"
        file.write_bytes(mutated(text, seed).encode("utf-8", "surrogatepass"))
        begin = time.process_time()
        checked = check(file)
        assert time.process_time() - begin < LONGEST_S, seed
        for diagnostic in checked.diagnostics:
            assert diagnostic.message, seed
            assert "\n" not in diagnostic.message, seed
            assert diagnostic.span.line >= 1, seed
