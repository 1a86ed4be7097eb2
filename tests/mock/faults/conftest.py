"""The cell of the chapter, built once, and rehearsals of it that stand in no folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from cellc.contract.rehearsals import FaultEntry, RehearsalEntry
from cellc.mock import MockCell, load
from cellc.mock.result import RehearsalResult
from cellc.output.write import write
from cellc.pipeline import check, compile_cell

ROOT = Path(__file__).resolve().parents[3]

Run = Callable[..., RehearsalResult]


@pytest.fixture(scope="session")
def cell(tmp_path_factory: pytest.TempPathFactory) -> MockCell:
    """The loaded cell `ur5e_pick`."""
    artifacts = compile_cell(check(ROOT / "cells" / "ur5e_pick" / "cell.yaml")).value
    assert artifacts is not None
    folder = tmp_path_factory.mktemp("generated") / "ur5e_pick"
    assert write(artifacts, folder).ok
    return load(folder)


@pytest.fixture(scope="session")
def plain(cell: MockCell) -> RehearsalEntry:
    """Its rehearsal without a fault: home, detect, pick, close, place, open, home."""
    return next(entry for entry in cell.entries if not entry.faults)


@pytest.fixture(scope="session")
def run(cell: MockCell, plain: RehearsalEntry) -> Run:
    """Run the plain rehearsal with faults."""

    def rehearse(*faults: FaultEntry, **changes: object) -> RehearsalResult:
        return cell.rehearse(plain.model_copy(update={"name": "faulty", "faults": faults, **changes}))

    return rehearse
