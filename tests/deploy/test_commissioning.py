"""What vendors have people do stands in the gates, at its place."""

from __future__ import annotations

import re
from typing import Any

import pytest

from tests.cells import DISTROS, ROOT, catalog_facts
from tests.emit.cells import CELLS, artifacts_of
from tests.foreign_yaml import safe_load


def _gates(cell: str, distro: str) -> dict[str, list[str]]:
    """Return the lines to tick of each gate."""
    artifacts = artifacts_of(cell, distro)
    text = artifacts["gates/promotion.md"] + artifacts["gates/network.md"]
    parts = re.split(r"^## ([GL]\d) .*$", text, flags=re.MULTILINE)[1:]
    return {
        code: re.findall(r"^- \[ \] (.*)$", body, re.MULTILINE)
        for code, body in zip(parts[::2], parts[1::2], strict=True)
    }


def _bare(text: str) -> str:
    return re.sub(r"[\\`*_]", "", text)


def _place(lines: list[str], word: str) -> int:
    return next(number for number, line in enumerate(lines) if word in line)


@pytest.mark.parametrize("distro", DISTROS)
@pytest.mark.parametrize("cell", CELLS)
def test_every_step_of_a_vendor_stands_in_its_gate_once(cell: str, distro: str) -> None:
    gates = _gates(cell, distro)
    spec = safe_load((ROOT / "cells" / cell / "cell.yaml").read_text(encoding="utf-8"))
    for name, device in spec["devices"].items():
        for step in catalog_facts(device["model"]).get("commissioning", []):
            said = step["does"].replace("{played_by}", device.get("program", _AT_THE_DEVICE)["played_by"])
            begins = f"{name}: {_bare(said)}"[:60]
            holding = [code for code, lines in gates.items() for line in lines if _bare(line).startswith(begins)]
            done = not step.get("when") or set(step["when"]) & _so(device)
            assert holding == ([step["gate"]] if done else []), step["does"]


_AT_THE_DEVICE = {"played_by": "a person", "mode": "local"}


def _so(device: dict[str, Any]) -> set[str]:
    """Return what is so of a device of a spec, of all that a step may be bound to."""
    program = device.get("program", _AT_THE_DEVICE)
    way = (
        "headless" if program["played_by"] == "driver" else {"local": "pendant", "remote": "dashboard"}[program["mode"]]
    )
    set_by = device.get("payload", {}).get("set_by", "installation")
    return {way, f"payload_by_{set_by}", "thresholds_stated" if "collision" in device else "thresholds_open"}


@pytest.mark.parametrize("distro", DISTROS)
def test_nobody_releases_brakes_or_fingers_before_the_stop_was_tried_and_the_area_is_empty(distro: str) -> None:
    lines = _gates("ur5e_pick", distro)["G5"]
    empty, tried = _place(lines, "no person and no loose object is within reach"), _place(lines, "trip the stop")
    # Drives that have no power cannot lose it: a stop that is tried on them is not tried.
    assert empty < _place(lines, "Payload of arm") < _place(lines, "release the brakes") < tried
    assert tried < _place(lines, "power the drives again") < _place(lines, "no robot on it runs a program")
    assert _place(lines, "no robot on it runs a program") < _place(lines, "Authorize hardware that moves")


@pytest.mark.parametrize("cell", CELLS)
def test_power_comes_before_the_trial_of_the_stop_and_fingers_after_it(cell: str) -> None:
    lines = _gates(cell, "jazzy")["G5"]
    tried = _place(lines, "trip the stop")
    assert all(number < tried for number, line in enumerate(lines) if "open the brakes" in line)
    assert all(
        number > tried for number, line in enumerate(lines) if "homing action" in line or "fingers moved" in line
    )


@pytest.mark.parametrize("cell", CELLS)
def test_mock_is_ended_before_anything_real_is_started(cell: str) -> None:
    # A mock that is left has the names and the domain of the real cell, and answers in its place.
    gates = _gates(cell, "jazzy")
    for code in ("G2", "L6"):
        assert gates[code][-1].startswith("Stop every launch of the mock")


@pytest.mark.parametrize("cell", ["ur5e_pick", "fr3_hand"])
def test_second_server_is_looked_for_before_anything_asks_for_motion(cell: str) -> None:
    lines = _gates(cell, "jazzy")["G7"]
    servers = [number for number, line in enumerate(lines) if line.endswith("has one server")]
    assert all(number < _place(lines, "Authorize the motion clients") for number in servers)


@pytest.mark.parametrize("distro", DISTROS)
def test_robot_listens_before_it_is_claimed_and_is_claimed_before_anything_asks_for_motion(distro: str) -> None:
    # Universal_Robots_ROS2_Driver issue 1084: a claim before the program plays is a jump when it does.
    gates = _gates("ur5e_pick", distro)
    lines = gates["G7"]
    play, claim, motion = (
        _place(lines, text) for text in ("press Play", "Authorize the claims", "Authorize the motion clients")
    )
    assert play < claim < motion
    assert not [line for code in ("G3", "G4", "G5", "G6") for line in gates[code] if "Authorize the claims" in line]


@pytest.mark.parametrize("distro", DISTROS)
def test_one_small_goal_ends_before_the_application_is_started(distro: str) -> None:
    # The application picks, grips and places at once: a person cannot follow that as the first motion.
    lines = _gates("ur5e_pick", distro)["G7"]
    small = _place(lines, "Move the joints one at a time with small goals")
    assert _place(lines, "Authorize the claims") < small < _place(lines, "Authorize the motion clients")


def test_load_is_read_back_before_the_brakes_open_and_a_robot_is_local_before_its_driver_starts() -> None:
    gates = _gates("ur5e_pick", "jazzy")
    assert _place(gates["G5"], "read both back there") < _place(gates["G5"], "release the brakes")
    assert _place(gates["G3"], "shows LOCAL") < _place(gates["G3"], "Authorize the hardware launch")
    assert _place(gates["G4"], "shows LOCAL") < _place(gates["G4"], "Authorize the hardware launch")


def test_fci_is_active_before_the_driver_that_connects_to_it_starts() -> None:
    # franka_ros2 v3.4.0: on_init connects, and without FCI it is an error.
    lines = _gates("fr3_hand", "humble")["G3"]
    assert _place(lines, "activate FCI in Desk") < _place(lines, "Authorize the hardware launch")


def test_program_that_a_stop_has_paused_is_stopped_before_anyone_goes_to_the_robot() -> None:
    # Universal_Robots_ROS2_Driver, doc/robot_state_helper.rst:54-58: resumed, the arm goes on with what it did.
    recovery = artifacts_of("ur5e_pick")["audit.md"].split("\n## Recovery\n")[1]
    for state in ("protective_stop", "emergency_stop"):
        steps = recovery.split(f"arm, {state}:")[1].split("\n\n")[1].splitlines()
        stopped, person, play, claim = (
            _place(steps, text)
            for text in ("Stop the program", "emove the cause", "Play the External", "Authorize the claims")
        )
        assert stopped < person < play < claim


@pytest.mark.parametrize("cell", CELLS)
def test_every_gate_has_a_place_for_result_name_date_and_signature(cell: str) -> None:
    artifacts = artifacts_of(cell)
    for file in ("gates/promotion.md", "gates/network.md"):
        sections = artifacts[file].split("\n## ")[1:]
        for section in sections:
            assert all(word in section.splitlines()[-1] for word in ("Result", "Name", "Date", "Signature"))
