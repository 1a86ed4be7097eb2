"""Evidence of every kind of fault: watching changes no run, and what went wrong stands in the bag and the report."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock import MockCell
from cellc.mock.cell import cell_of
from cellc.mock.faults.registry import possible_faults
from tests.mock.conftest import Written, received, write_evidence

PICK = 3
"""Number of the step that moves the arm to the part."""


def faulty(cell: MockCell) -> tuple[RehearsalEntry, ...]:
    """The first fault of each kind, begun with the step that moves to the part."""
    plain = next(entry for entry in cell.entries if not entry.faults)
    first = {case.entry.kind: case for case in reversed(possible_faults(cell.contract))}
    return tuple(
        plain.model_copy(update={"name": kind, "faults": (case.at(PICK),)}) for kind, case in sorted(first.items())
    )


@pytest.fixture(scope="module")
def disturbed(cell: MockCell) -> MockCell:
    return cell_of(replace(cell.folder, rehearsals=faulty(cell)))


@pytest.fixture(scope="module")
def evidence(disturbed: MockCell, tmp_path_factory: pytest.TempPathFactory) -> Written:
    return write_evidence(disturbed, tmp_path_factory.mktemp("evidence") / "faults")


def test_watching_changes_no_disturbed_run(disturbed: MockCell, evidence: Written) -> None:
    assert len(evidence.results) > 8
    for name, result in evidence.results.items():
        assert disturbed.run(name) == result, name


def test_every_bag_is_read_back_and_every_attempt_stands_in_it(evidence: Written) -> None:
    for name, result in evidence.results.items():
        attempts = list(received(evidence.bag(name), "/cellc/attempts"))
        assert [json.loads(each.message.data)["outcome"] for each in attempts] == [
            record.outcome for record in result.attempts
        ]


def test_late_joint_states_are_logged_when_they_arrive(evidence: Written) -> None:
    late = list(received(evidence.bag("delay"), "/joint_states"))
    ages = [each.log_ns - each.message.header.stamp.sec * 10**9 - each.message.header.stamp.nanosec for each in late]
    assert min(ages) == 0
    assert max(ages) > 100_000_000  # older than the cell allows, or the fault would be none


def test_missed_cycles_are_counted_and_told(evidence: Written) -> None:
    figures = json.loads((evidence.folder / "skip_cycles.kpis.json").read_text(encoding="utf-8"))["kpis"]
    missed = next(figure for figure in figures if figure["name"] == "missed_cycles")
    assert missed["value"] > 0
    assert missed["met"] is False
    statuses = [each.message.status for each in received(evidence.bag("skip_cycles"), "/diagnostics")]
    last = next(status for status in statuses[-1] if status.name.endswith("Update Cycles"))
    assert last.level == 2  # ERROR
    assert last.values[0].value == str(missed["value"])


def test_goal_of_a_second_commander_stands_in_the_bag(evidence: Written) -> None:
    goals = list(received(evidence.bag("second_commander"), "/cellc/arm_trajectory/goal"))
    sent = sum(record.controller_name == "arm_trajectory" for record in evidence.results["second_commander"].attempts)
    assert len(goals) == sent + 1


def test_report_marks_the_attempt_that_failed(evidence: Written) -> None:
    page = Path(evidence.folder / "report.html").read_text(encoding="utf-8")
    for name, result in evidence.results.items():
        assert f"Rehearsal {name}" in page
        assert result.attempts[-1].outcome in page
