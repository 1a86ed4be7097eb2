"""Devices that digital outputs switch: a gripper that takes a part, a door, and a sensor that never comes."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.contract.devices import ContractSwitched
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, StepEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import load
from cellc.mock.cell import cell_of
from cellc.mock.faults.registry import possible_faults
from cellc.mock.folder import GeneratedFolder
from cellc.mock.plant import Plant
from cellc.mock.result import RehearsalResult
from tests.cells import CORPUS, build_into


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> GeneratedFolder:
    """The folder of a cell with a gripper, a lamp and a door on digital signals."""
    built: Path = build_into(tmp_path_factory.mktemp("switched"), CORPUS / "valid" / "switched_devices.yaml")
    return load(built).folder


def run(folder: GeneratedFolder, *steps: StepEntry, faults: tuple[FaultEntry, ...] = ()) -> RehearsalResult:
    """Run steps that are expected to succeed."""
    return _run(folder, steps, faults)[0]


def _run(
    folder: GeneratedFolder, steps: tuple[StepEntry, ...], faults: tuple[FaultEntry, ...] = ()
) -> tuple[RehearsalResult, Plant]:
    plants: list[Plant] = []
    entry = RehearsalEntry(name="switched", steps=steps, faults=faults, expect=AttemptOutcome.SUCCEEDED, timeout_s=60.0)
    result = cell_of(folder).rehearse(entry, watch=plants.append)
    return result, plants[0]


def changed(folder: GeneratedFolder, name: str, **changes: object) -> GeneratedFolder:
    """Return a folder whose switched device has other facts."""
    device = folder.contract.devices[name]
    switched = ContractSwitched.model_validate({**dict(device.switched or ()), **changes})
    devices = {**folder.contract.devices, name: device.model_copy(update={"switched": switched})}
    return replace(folder, contract=folder.contract.model_copy(update={"devices": devices}))


def step(kind: str, target: str, state: str | None = None) -> StepEntry:
    """Return a step."""
    return StepEntry.model_validate({"kind": kind, "target": target, "state": state})


CLOSED = (step("set", "gripper", "closed"), step("sense", "gripper", "closed"))
SILENT = FaultEntry(kind=FaultKind.SILENT_SENSOR, target="gripper", event=FaultEvent(step=1))


def test_a_gripper_tells_that_it_is_closed_after_its_switch_time(folder: GeneratedFolder) -> None:
    sensed = run(folder, *CLOSED).attempts[1]
    # 150 ms of the spec, and the look every 10 ms of a client.
    assert 0.150 <= (sensed.ended_ns - sensed.started_ns) / 1e9 <= 0.161


def test_a_sensor_that_never_comes_ends_the_attempt_after_the_time_of_the_spec(folder: GeneratedFolder) -> None:
    result = run(folder, *CLOSED, faults=(SILENT,))
    assert result.outcome == AttemptOutcome.TIMEOUT
    failed = result.attempts[1]
    assert (failed.ended_ns - failed.started_ns) / 1e9 == pytest.approx(0.5, abs=0.011)
    assert "closed reads false" in failed.fault_code


def test_a_sensor_that_is_silent_for_a_while_is_waited_for(folder: GeneratedFolder) -> None:
    mended = SILENT.model_copy(update={"lasting_s": 0.3})
    assert run(folder, *CLOSED, faults=(mended,)).outcome == AttemptOutcome.SUCCEEDED


def test_a_door_that_is_open_keeps_the_cell_from_its_first_motion(folder: GeneratedFolder) -> None:
    steps = (step("sense", "door", "shut"), step("move", "home"))
    assert run(folder, *steps).outcome == AttemptOutcome.SUCCEEDED
    result = run(changed(folder, "door", starts="open"), *steps)
    assert result.outcome == AttemptOutcome.TIMEOUT
    assert result.attempts[0].step == "sense door shut"


def test_what_is_between_the_jaws_is_carried_and_let_go(folder: GeneratedFolder) -> None:
    result, plant = _run(folder, tuple(folder.rehearsals[0].steps))
    assert result.outcome == AttemptOutcome.SUCCEEDED
    fixture = plant.world.link_pose("fixture_A", plant.now_ns).position
    # It was put down at the goal `place`, 10 mm over the fixture; before, it lay a quarter of a metre beside it.
    assert math.dist(plant.world.object_pose("object", plant.now_ns).position, fixture) < 0.05


def test_a_gripper_that_opens_before_it_was_closed_takes_nothing(folder: GeneratedFolder) -> None:
    steps = (*folder.rehearsals[0].steps[:5], step("set", "gripper", "closed"), step("set", "gripper", "open"))
    result, plant = _run(folder, (*steps, step("move", "home")))
    assert result.outcome == AttemptOutcome.SUCCEEDED
    fixture = plant.world.link_pose("fixture_A", plant.now_ns).position
    assert math.dist(plant.world.object_pose("object", plant.now_ns).position, fixture) > 0.2


def test_the_campaign_silences_each_sensor_that_is_wired(folder: GeneratedFolder) -> None:
    cases = [case for case in possible_faults(folder.contract) if case.entry.kind == FaultKind.SILENT_SENSOR]
    assert {case.entry.target for case in cases} == {"gripper", "door"}
    gripper = next(case for case in cases if case.entry.target == "gripper")
    assert AttemptOutcome.TIMEOUT in gripper.outcomes(CLOSED, 1)
    assert gripper.outcomes((step("set", "lamp", "lit"),), 1) == {AttemptOutcome.SUCCEEDED}
