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


def _stopped(cell: str, device: str) -> str:
    """Return the line of the stop during a goal; without a way to trip it out of reach, what would follow is known."""
    unknown = re.findall(rf"- \[ \] (UNKNOWN: how to trip \w+ of {device} .*)", _gate(cell, "G7"))
    lines = [*(line for line in _drills(cell, "G7", device) if "small goal" in line), *map(str, unknown)]
    assert len(lines) == 1
    return lines[0]


@pytest.mark.parametrize("cell", _COMPONENTS)
def test_stop_during_a_goal_leaves_what_the_mock_plays(cell: str) -> None:
    device, step, name, _, watched = _COMPONENTS[cell]
    line = _stopped(cell, device)
    kind = FaultKind.EMERGENCY_STOP if "emergency stop" in line else FaultKind.PROTECTIVE_STOP
    done = of(cell, during(step, kind, device))
    assert f"Its hardware component must be {component(done, name)}." in line
    assert ("No topic reports this" in line) == (done.failed.safety_state == "normal")
    # A watch that hears of a stop ends the claim; the driver of an FR3 does it by itself, that of an OpenArm never.
    assert ("its claim must be dropped" in line) == watched
    assert ("Once it has stopped, the arm must not move." in line) == (cell != "openarm_bimanual")
    fell = any("fell when it stopped" in finding for finding in done.result.findings)
    assert ("The arm falls" in line) == fell


@pytest.mark.parametrize("cell", _COMPONENTS)
def test_states_by_hand(cell: str) -> None:
    device, _, _, state, _ = _COMPONENTS[cell]
    line = _stopped(cell, device)
    assert f"must be {state}." in line


def test_a_cable_is_not_unplugged_where_the_arm_jumps_on_reconnection() -> None:
    # tests/mock/faults/test_vendors.py: an OpenArm that is connected again jumps to where its trajectory is by then.
    drills = " ".join(_drills("openarm_bimanual", "G5", "left"))
    kept = "Do not unplug the communication cable of the arm while its hardware component is active. "
    assert f"{kept}The arm goes to old set points in one step on reconnection." in drills
    assert "Unplug the communication cable of the arm for 10 s" in " ".join(_drills("fr3_hand", "G5", "arm"))


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_every_drill_is_made_before_the_task_may_move(cell: str) -> None:
    gate = _gate(cell, "G7")
    task = gate.find("Authorize the motion clients")
    if task > 0:
        assert gate.rfind("Drill of ") < task


def test_the_interlock_of_two_arms_is_tried_with_each() -> None:
    gate = _gate("dual_ur", "G7")
    assert re.search(r"Move one arm into area \S+ with small goals and have another arm request the area", gate)


@pytest.mark.parametrize("cell", ["ur5e_pick", "fr3_hand", "openarm_bimanual"])
def test_a_claim_is_made_again_before_the_motion_clients_are_started(cell: str) -> None:
    # Each stop drops the claim: nothing after the drill can move without the way back.
    for device in (each.name for each in built(cell).graph.cell.devices if each.kind == "arm"):
        assert "Follow Recovery of " in _drills(cell, "G7", device)[-1]
        assert _drills(cell, "G7", device)[-1].endswith("The controllers of the arm must be active again.")


def test_nobody_pushes_against_a_moving_arm() -> None:
    # KINOVA Gen3 User Guide: no fault of it is tripped from outside; an FR3 has its activation device
    # (libfranka@0.20.4 docs/getting_started.rst:15), a UR its safeguard inputs (UR5 User Manual 3.1, 15.12).
    assert "UNKNOWN: how to trip fault of arm from out of its reach" in _gate("gen3_2f", "G7")
    assert "Press its activation device while the arm moves on a small goal" in _gate("fr3_hand", "G7")
    assert "Open the safeguard that is wired to its safety inputs while the arm moves" in _gate("ur5e_pick", "G7")


def test_arms_of_one_launch_are_all_on_stands_before_it_ends() -> None:
    # openarm_hardware/src/v10_simple_hardware.cpp:230: on deactivation the motors of each arm switch off.
    (line,) = _drills("openarm_bimanual", "G5", "left and right")
    words = ("stand just below left and right", "End the hardware launch", "Each arm falls", "Start the launch again")
    places = [line.index(each) for each in words]
    assert places == sorted(places)
    (line,) = _drills("dual_ur", "G5", "loader and unloader")
    assert "No arm may move." in line
    assert "support it" not in _gate("openarm_bimanual", "G7")


def test_cables_are_tried_before_the_restart_that_some_drivers_need() -> None:
    # No source says that a driver of a UR restores a lost connection.
    drills = _drills("ur5e_pick", "G5", "arm")
    assert [line.split()[0] for line in drills] == ["Unplug", "Plug", "End"]
    assert "robot_program_running" not in " ".join(drills)
