"""Memory is flat over simulated time."""

from __future__ import annotations

import tracemalloc

from cellc.contract.rehearsals import StepEntry
from cellc.contract.steps import StepKind
from cellc.mock import MockCell


def peak_bytes(cell: MockCell, seconds: float) -> int:
    """Return the most memory that a wait of some simulated seconds needs."""
    entry = cell.entries[0].model_copy(
        update={"steps": (StepEntry(kind=StepKind.WAIT, target="", duration_s=seconds),), "timeout_s": 2.0 * seconds}
    )
    tracemalloc.start()
    try:
        assert cell.rehearse(entry).outcome == "succeeded"
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_ten_minutes_need_no_more_memory_than_one(cells: dict[str, MockCell]) -> None:
    cell = cells["minimal"]
    assert cell.run(cell.rehearsals[0]).passed  # what loads late has loaded
    one, ten = peak_bytes(cell, 60.0), peak_bytes(cell, 600.0)
    assert ten < 1.05 * one
