"""The example cells, built once, and their campaigns."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.contract.contract import Contract
from cellc.mock import MockCell, load
from cellc.mock.campaign.campaign import make_plan
from cellc.mock.campaign.plan import CampaignPlan
from cellc.mock.command import campaign as command  # FIXME rename
from cellc.mock.faults.case import FaultCase
from cellc.mock.faults.possible import possible_faults
from cellc.output.write import write
from cellc.pipeline import check, compile_cell

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Generated folders of all example cells by name; never changed."""
    output = tmp_path_factory.mktemp("campaign")
    built: dict[str, Path] = {}
    for source in sorted((ROOT / "cells").glob("*/cell.yaml")):
        artifacts = compile_cell(check(source)).value
        assert artifacts is not None
        built[source.parent.name] = output / source.parent.name
        assert write(artifacts, built[source.parent.name]).ok
    return built


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

    monkeypatch.setattr(command, "possible_faults", few)


def plan_of(cell: MockCell) -> CampaignPlan:
    """Plan a campaign of everything that the cell can meet."""
    return make_plan(cell, possible_faults(cell.contract), seed=0)[0]
