"""Every row of the table of facts is named by a test, or by a reason why it is left out."""

from __future__ import annotations

import importlib

import pytest

from .fact_rows import FACTS, HELD, rows_of

for part in ("acceptance", "execution", "outcomes", "grippers"):
    importlib.import_module(f"{__package__}.test_rows_of_{part}")

LEFT_OUT = {("5", 2)}
"""The passthrough controller hands whole trajectories to the vendor's controller; it runs on real hardware alone."""


@pytest.mark.skipif(not FACTS.exists(), reason="the table of facts is not beside the checkout")
@pytest.mark.parametrize("section", ["1", "2", "3", "4", "5", "6"])
def test_every_row_is_named(section: str) -> None:
    rows = rows_of(section)
    assert rows
    named = {number for held, number in HELD | LEFT_OUT if held == section}
    assert named == set(range(1, len(rows) + 1)), rows
