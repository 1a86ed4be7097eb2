"""Drills on the robot have the outcome that the mock gives for this vendor, and are made before the task may move."""

from __future__ import annotations

import re

import pytest

from cellc.contract.faults import FaultKind
from tests.cells import EVERY_CELL, built
from tests.mock.faults.conftest import during
from tests.mock.faults.test_vendors import component, of

_COMPONENTS = {
    "ur5e_pick": ("arm", 3, "arm_hardware", "active", True),
    "fr3_hand": ("arm", 2, "FrankaHardwareInterface", "unconfigured", False),
    "gen3_2f": ("arm", 2, "KortexMultiInterfaceHardware", "active", True),
    "openarm_bimanual": ("left", 2, "openarm_left_hardware_interface", "active", False),
}


def _gate(cell: str, code: str) -> str:
    return built(cell).texts["gates/promotion.md"].split(f"\n## {code}")[1].split("\n## ")[0].replace("\\", "")


def _drills(cell: str, code: str, device: str) -> list[str]:
    return re.findall(rf"- \[ \] Drill of {device}: (.*)", _gate(cell, code))


@pytest.mark.parametrize("cell", _COMPONENTS)
def test_stop_during_a_goal_leaves_what_the_mock_plays(cell: str) -> None:
    device, step, name, _, watched = _COMPONENTS[cell]
    (line,) = (line for line in _drills(cell, "G7", device) if line.startswith("Trip "))
    kind = FaultKind.EMERGENCY_STOP if "emergency_stop" in line else FaultKind.PROTECTIVE_STOP
    done = of(cell, during(step, kind, device))
    assert f"Its component must be {component(done, name)}." in line
    assert ("No topic reports it" in line) == (done.failed.safety_state == "normal")
    # A watch that hears of a stop ends the claim; the driver of an FR3 does it by itself, that of an OpenArm never.
    assert ("its claim must be dropped" in line) == watched
    fell = any("fell as it stopped" in finding for finding in done.result.findings)
    assert ("It falls" in line) == fell


@pytest.mark.parametrize("cell", _COMPONENTS)
def test_states_by_hand(cell: str) -> None:
    device, _, _, state, _ = _COMPONENTS[cell]
    (line,) = (line for line in _drills(cell, "G7", device) if line.startswith("Trip "))
    assert f"must be {state}." in line


def test_a_cable_is_not_unplugged_where_the_arm_jumps_on_reconnection() -> None:
    # tests/mock/faults/test_vendors.py: an OpenArm that is connected again jumps to where its trajectory is by then.
    drills = " ".join(_drills("openarm_bimanual", "G5", "left"))
    kept = "Do not unplug its communication cable while it is active. On reconnection: It goes to old set points"
    assert kept in drills
    assert "Unplug its communication cable for 10 s" in " ".join(_drills("fr3_hand", "G5", "arm"))


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_every_drill_is_made_before_the_task_may_move(cell: str) -> None:
    gate = _gate(cell, "G7")
    task = gate.find("Authorize the motion clients")
    if task > 0:
        assert gate.rfind("Drill of ") < task


def test_the_interlock_of_two_arms_is_tried_with_each() -> None:
    gate = _gate("dual_ur", "G7")
    assert re.search(r"Move one arm into area \S+ by small goals and have another ask for it", gate)
