"""The example cells, built once, and their campaigns."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.contract.contract import Contract
from cellc.mock import MockCell, load
from cellc.mock.campaign.campaign import make_plan
from cellc.mock.campaign.plan import CampaignPlan
from cellc.mock.command import campaign
from cellc.mock.faults.cases import FaultCase
from cellc.mock.faults.registry import possible_faults
from tests.cells import CELLS, generated


@pytest.fixture(scope="session")
def folders() -> dict[str, Path]:
    """Generated folders of all example cells by name; never changed."""
    return {name: generated(name) for name in CELLS}


@pytest.fixture(scope="session")
def cells(folders: dict[str, Path]) -> dict[str, MockCell]:
    """The loaded cells by name."""
    return {name: load(folder) for name, folder in folders.items()}


@pytest.fixture
def few_faults(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the command plan with two kinds of fault, where a test is about what it prints."""

    def few(contract: Contract) -> tuple[FaultCase, ...]:
        return tuple(
            case for case in possible_faults(contract) if case.entry.kind in ("protective_stop", "skip_cycles")
        )

    monkeypatch.setattr(campaign, "possible_faults", few)


def plan_of(cell: MockCell) -> CampaignPlan:
    """Plan a campaign of everything that the cell can meet."""
    return make_plan(cell, possible_faults(cell.contract), seed=0)[0]
