"""A campaign around a task node that is not played: every fault that is on the graph, on a graph without ROS."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock import MockCell
from cellc.mock.campaign.campaign import execute, make_plan
from cellc.mock.campaign.plan import CampaignPlan, CampaignRun, RunEnd
from cellc.mock.cell import Watch, cell_of
from cellc.mock.faults.registry import possible_faults
from cellc.mock.result import RehearsalResult
from cellc.mock.ros.session import concerns
from tests.mock.ros.task_stand_in import run

_ELSEWHERE = ("double_frame", "mismatch_qos", "unreachable")
"""Faults of the task that is played; docs/mock.md names them."""


@pytest.fixture(scope="module")
def plan(cell: MockCell) -> CampaignPlan:
    return make_plan(cell, possible_faults(cell.contract), 0)[0]


def _end(cell: MockCell, monkeypatch: pytest.MonkeyPatch, chosen: CampaignRun, wrong: str = "") -> RunEnd:
    known = cell_of(replace(cell.folder, rehearsals=(*cell.entries, chosen.entry)))

    def rehearse(_: MockCell, entry: RehearsalEntry, seed: int, watch: Watch) -> RehearsalResult:
        return run(known, monkeypatch, entry.name, wrong, watch=watch).result

    return execute(cell, chosen, 0, rehearse)


@pytest.mark.parametrize("kind", FaultKind)
def test_a_right_node_passes_a_campaign(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, plan: CampaignPlan, kind: FaultKind
) -> None:
    runs = [each for each in plan.singles() if each.hits[0].fault.partition(":")[0] == kind]
    seen = [each for each in runs if concerns(cell.contract, ("task",), each.entry.faults[0])]
    assert bool(seen) is (bool(runs) and kind not in _ELSEWHERE)
    for chosen in seen[:1] if kind is FaultKind.SCALE_SPEED else (*seen[:1], *seen[len(seen) // 2 :][:1]):
        end = _end(cell, monkeypatch, chosen)
        assert end.passed, (chosen.identifier, end.result, chosen.outcomes, chosen.within_s)


_WRONG = {
    "endless": (
        "unresponsive:gripper_action@4.moving",
        "not_stopped: `/task` let its goal of `/gripper_action/gripper_cmd` execute for 0.3 s more: no result from "
        "gripper_action within 10 s",
    ),
    "blind_grip": (
        "freeze:camera@4",
        "not_stopped: `/task` let its goal of `/gripper_action/gripper_cmd` execute for 0.3 s more: newest observation",
    ),
    "retries": (
        "protective_stop:arm@3.moving",
        "commanded_while_stopped: `/task` sent a goal to `/move_action` while hardware component arm_hardware reports "
        "protective_stop",
    ),
    "deaf": (
        "cancel:grip@4",
        "cancel_ignored: `/task` let its goal of `/gripper_action/gripper_cmd` execute for 0.3 s more",
    ),
}


@pytest.mark.parametrize("wrong", _WRONG)
def test_a_wrong_node_is_named_by_a_fault(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, plan: CampaignPlan, wrong: str
) -> None:
    hit, text = _WRONG[wrong]
    chosen = plan.find(f"pick_and_place/{hit}")
    assert chosen is not None
    end = _end(cell, monkeypatch, chosen, wrong)
    assert not end.passed
    assert any(line.startswith(text) for line in end.result.violations), end.result
