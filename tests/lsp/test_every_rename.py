"""Another name for everything that has one, in every cell: the same findings, and the review calls it a rename.

A session takes one name of sixteen, others in each cell; with ``--long`` every name is taken.
"""

from __future__ import annotations

import pytest

from cellc.compiler.source import read
from tests.cells import EVERY_CELL, spec_of, there
from tests.lsp.renames import faults_of_a_rename, names
from tests.sample import sample

_SHARE = 16


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_every_name_of_a_cell_can_become_another_one(cell: str, request: pytest.FixtureRequest) -> None:
    document = there(read(spec_of(cell)).value)
    paths = list(names(document))
    assert len(paths) > 8
    taken = sample(request, paths, _SHARE, lambda path: f"{cell} {path}")
    assert [fault for path in taken for fault in faults_of_a_rename(document, path)] == []
