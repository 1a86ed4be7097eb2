"""What the mock publishes of joints behind springs, against the energy of the links that another library places."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cellc.mock import MockCell, load
from cellc.mock.cell import cell_of
from cellc.mock.control.hardware.spring_joints import SpringJoints
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.plant import Plant
from cellc.mock.reality import Reality
from cellc.mock.result import RehearsalResult
from tests.cells import generated
from tests.planning.test_droop import Energy, urdf

Positions = dict[str, float]
USUAL = (70.0, 70.0, 70.0, 60.0, 10.0, 10.0, 10.0)
LEFT = tuple(f"openarm_left_joint{number}" for number in range(1, 8))


@pytest.fixture(scope="module")
def openarm() -> MockCell:
    return load(generated("openarm_bimanual"))


@pytest.fixture(scope="module")
def fr3() -> MockCell:
    return load(generated("fr3_hand"))


def run(cell: MockCell, name: str, reality: Reality | None = None) -> tuple[RehearsalResult, Plant]:
    seen: list[Plant] = []
    result = cell.rehearse(cell.entry(name), watch=seen.append, reality=reality)
    return result, seen[-1]


def published(plant: Plant, at_ns: int) -> Positions:
    return {joint: at for history in plant.control.histories.values() for joint, at in history.at(at_ns).items()}


def pose(plant: Plant, name: str) -> Positions:
    (target,) = plant.contract.poses[name]
    return dict(zip(plant.contract.groups[target.group].joints, target.positions, strict=True))


def wait(plant: Plant) -> None:
    """Let a second pass."""

    def body() -> Waiting[None]:
        yield Wait(plant.now_ns + 10**9, ())

    plant.simulation.run_process(body())


def ends(result: RehearsalResult) -> dict[str, int]:
    return {record.step: record.ended_ns for record in result.attempts}


def test_published_joints_are_below_their_commands_by_their_weight(openarm: MockCell) -> None:
    result, plant = run(openarm, "both_reach")
    assert result.passed
    law = plant.contract.devices["left"].law
    assert law is not None
    energy, worst = Energy(urdf("openarm_bimanual"), (), robot_too=True), 0.0
    commanded = dict(zip(LEFT, np.radians([-25, -10, 0, 90, 0, 0, 0]).tolist(), strict=True))
    at = published(plant, next(end for step, end in ends(result).items() if step.startswith("grip close left")))
    for joint, spring in law.joints.items():
        droop = commanded[joint] - at[joint]
        assert droop == pytest.approx(energy.torque(joint, at) / spring.stiffness, rel=0.01, abs=3e-4), joint
        worst = max(worst, abs(droop))
    assert 0.025 < worst < 0.035


def test_usual_gains_of_the_vendor_end_beyond_the_tolerance_of_the_goal(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(generated("openarm_bimanual"), tmp_path / "cell"))
    contract = json.loads((folder / "contract.json").read_text())
    for side in ("left", "right"):
        joints = contract["devices"][side]["law"]["joints"]
        for joint, stiffness in zip(joints, USUAL, strict=True):
            joints[joint]["stiffness"] = stiffness
    (folder / "contract.json").write_text(json.dumps(contract))
    result, _ = run(load(folder, edited=True), "both_reach")
    assert (result.passed, result.outcome) == (False, "tolerance_violation")
    assert result.attempts[-1].fault_code.startswith("-5: Aborted due to goal_time_tolerance exceeding")


def test_canceled_arm_holds_what_is_measured_and_sinks_by_its_droop_again(openarm: MockCell) -> None:
    result, plant = run(openarm, "canceled")
    (canceled,) = (record for record in result.attempts if record.cancel is not None)
    assert canceled.cancel is not None
    assert canceled.cancel.held_ns is not None
    asked, held = (published(plant, at) for at in (canceled.cancel.requested_ns, canceled.cancel.held_ns))
    energy = Energy(urdf("openarm_bimanual"), (), robot_too=True)
    law = plant.contract.devices["left"].law
    assert law is not None
    expected = {joint: energy.torque(joint, held) / spring.stiffness for joint, spring in law.joints.items()}
    worst = max(expected, key=lambda joint: abs(expected[joint]))
    assert abs(expected[worst]) > 0.006
    assert asked[worst] - held[worst] == pytest.approx(expected[worst], rel=0.02)


def test_part_between_the_fingers_lowers_the_joints(fr3: MockCell) -> None:
    result, plant = run(fr3, "tray_to_press")
    law = plant.contract.devices["arm"].law
    assert result.passed
    assert law is not None
    assert law.part is not None
    empty = published(plant, plant.now_ns)
    plant.loads.hold("hand", holds=True)
    wait(plant)
    full = published(plant, plant.now_ns)
    energy = Energy(urdf("fr3_hand"), (law.part,), robot_too=False)
    for joint in ("fr3_joint2", "fr3_joint4", "fr3_joint6"):
        expected = energy.torque(joint, full) / law.joints[joint].stiffness
        assert abs(expected) > 2e-5
        assert empty[joint] - full[joint] == pytest.approx(expected, rel=0.02), joint


def test_heavier_part_and_wrong_compensation_move_the_joints(fr3: MockCell) -> None:
    stated, drawn = Reality(), Reality(part_more_kg={"arm": 0.1}, compensation={"arm": -0.01})
    law = fr3.contract.devices["arm"].law
    assert law is not None
    found = []
    for reality in (stated, drawn):
        result, plant = run(fr3, "tray_to_press", reality)
        found.append(published(plant, next(end for step, end in ends(result).items() if step.startswith("move pick"))))
    elbow = "fr3_joint4"
    robot = Energy(
        urdf("fr3_hand"), tuple(replace(one, mass_kg=-one.mass_kg) for one in law.unaccounted), robot_too=True
    )
    expected = 0.01 * robot.torque(elbow, found[1]) / law.joints[elbow].stiffness
    assert found[0][elbow] - found[1][elbow] == pytest.approx(expected, rel=0.05)


def test_copied_cell_ends_bit_by_bit_as_one_that_comes_up(fr3: MockCell) -> None:
    drawn = Reality(part_more_kg={"arm": 0.05}, compensation={"arm": 0.01})
    entry, copied = fr3.entry("tray_to_press"), cell_of(fr3.folder)
    copied.rehearse(entry)
    assert repr(copied.rehearse(entry, reality=drawn)) == repr(cell_of(fr3.folder).rehearse(entry, reality=drawn))


def test_joints_that_are_where_they_are_commanded_have_no_springs(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("bound")

    monkeypatch.setattr(SpringJoints, "__init__", refuse)
    cell = load(generated("ur5e_pick"))
    assert cell.run("pick_and_place").passed
    with pytest.raises(AssertionError, match="bound"):
        load(generated("fr3_hand")).run("tray_to_press")


def test_device_behind_an_adapter_says_where_its_joints_are() -> None:
    result, plant = run(load(generated("hybrid_sdk")), "polished")
    assert result.passed
    law = plant.contract.devices["arm"].law
    assert law is not None
    wait(plant)
    wanted, at = pose(plant, "home"), published(plant, plant.now_ns)
    energy = Energy(urdf("hybrid_sdk"), law.unaccounted, robot_too=False)
    for joint, spring in law.joints.items():
        expected = energy.torque(joint, at) / spring.stiffness
        assert wanted[joint] - at[joint] == pytest.approx(expected, rel=0.02, abs=2e-5), joint
