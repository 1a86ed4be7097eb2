"""Memory is flat over simulated time."""

from __future__ import annotations

import tracemalloc

from cellc.contract.rehearsals import StepEntry
from cellc.mock import MockCell


def peak_bytes(cell: MockCell, seconds: float) -> int:
    """Return the most memory that a wait of some simulated seconds needs."""
    entry = cell.entries[0].model_copy(
        update={"steps": (StepEntry(kind="wait", target="", duration_s=seconds),), "timeout_s": 2.0 * seconds}
    )
    tracemalloc.start()
    try:
        assert cell.rehearse(entry).outcome == "succeeded"
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_quarter_of_an_hour_needs_no_more_memory_than_a_minute(cells: dict[str, MockCell]) -> None:
    cell = cells["minimal"]
    assert cell.run(cell.rehearsals[0]).passed  # what loads late has loaded
    minute, quarter = peak_bytes(cell, 60.0), peak_bytes(cell, 900.0)
    assert quarter < 1.05 * minute
