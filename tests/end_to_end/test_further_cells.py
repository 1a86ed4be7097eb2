"""Every cell of the repository as it is committed: short, and each of its rehearsals ends as it should.

That the committed folders are what the compiler writes is held by `test_byte_identity.py`.
"""

from __future__ import annotations

import pytest

from cellc.mock import load
from tests.cells import CELLS, EVERY_CELL, ROOT, spec_text

FURTHER = tuple(cell for cell in EVERY_CELL if cell not in CELLS)


@pytest.mark.parametrize("name", FURTHER)
def test_a_further_cell_is_short_and_its_rehearsals_pass(name: str) -> None:
    assert len(spec_text(name).splitlines()) <= 120
    cell = load(ROOT / "generated" / name)
    ended = {one: cell.run(one, seed=0) for one in cell.rehearsals}
    assert not [f"{one}: {result.outcome}" for one, result in ended.items() if not result.passed]
    assert len(ended) >= 4
