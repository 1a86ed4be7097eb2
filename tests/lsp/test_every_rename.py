"""Another name for everything that has one, in every cell: the same findings, and the review calls it a rename.

A session takes one name of four, others in each cell; with ``--long`` every name is taken.
"""

from __future__ import annotations

import zlib

import pytest

from cellc.compiler.source import read
from tests.cells import EVERY_CELL, spec_of, there
from tests.lsp.renames import faults_of_a_rename, names

_SHARE = 4


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_every_name_of_a_cell_can_become_another_one(cell: str, request: pytest.FixtureRequest) -> None:
    document = there(read(spec_of(cell)).value)
    paths = list(names(document))
    assert len(paths) > 8
    every = request.config.option.long
    taken = [path for path in paths if every or zlib.crc32(f"{cell} {path}".encode()) % _SHARE == 0]
    assert taken
    assert [fault for path in taken for fault in faults_of_a_rename(document, path)] == []
