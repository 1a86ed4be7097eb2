"""Evidence of a cell whose arm is driven by its own library: no controller manager, and still a bag and a report."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cellc.contract.rehearsals import RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.mock import load
from cellc.mock.cell import cell_of
from tests.cells import CORPUS, build_into
from tests.mock.conftest import Written, received, write_evidence


@pytest.fixture(scope="module")
def adapted(tmp_path_factory: pytest.TempPathFactory) -> Written:
    folder = build_into(tmp_path_factory.mktemp("generated") / "demo", CORPUS / "valid" / "direct_sdk_arm.yaml")
    steps = tuple(StepEntry(kind=StepKind.MOVE, target=pose) for pose in ("home", "aside"))
    entry = RehearsalEntry(name="reach", steps=steps, faults=(), expect="succeeded", within_s=None, timeout_s=60.0)
    cell = cell_of(replace(load(folder).folder, rehearsals=(entry,)))
    return write_evidence(cell, folder.parent / "evidence")


def test_goals_and_states_of_the_device_stand_in_the_bag(adapted: Written) -> None:
    assert adapted.results["reach"].passed
    goals = list(received(adapted.bag("reach"), "/cellc/arm/goal"))
    states = list(received(adapted.bag("reach"), "/joint_states"))
    assert len(goals) == 2
    aside = goals[-1].message.points[-1].positions.tolist()
    by_name = dict(zip(states[-1].message.name, states[-1].message.position.tolist(), strict=True))
    assert [by_name[name] for name in goals[-1].message.joint_names] == pytest.approx(aside, abs=1e-3)


def test_report_shows_its_joints_without_a_trajectory_controller(adapted: Written) -> None:
    page = (adapted.folder / "report.html").read_text(encoding="utf-8")
    assert "State of joints that no trajectory controller drives" in page
    assert "Command, state and error of each joint" not in page
    assert "arm_joint_6: state over time" in page
