"""The record that is read from a bag equals the mock's own: rehearsals of every cell, and runs with faults.

A session takes one run of four; with ``--long`` every one is taken. The mock's records lie beside its bags, and are no
part of what is read: the topics under ``/cellc`` are left out.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cellc.contract.attempt import Layer
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.folder import read_folder
from cellc.tools.attempt.read import read_attempt
from cellc.tools.attempt.record import UNKNOWN, to_json
from tests.cells import EVERY_CELL, generated
from tests.cli.run import run
from tests.sample import sample

_SHARE = 4

FAULTS = (
    *("freeze:arm@6", "freeze:arm@3.moving", "delay:arm@5.moving", "delay:camera@3", "drop_frame:arm_shoulder_link@3"),
    *("jump_clock:control_pc:forwards@4.moving", "jump_clock:camera:forwards@3", "unresponsive:gripper_action@6"),
    *("mismatch_qos:/arm_trajectory/follow_joint_trajectory@3", "mismatch_qos:/joint_states@3.moving"),
    *("unresponsive:move_group@6.moving", "unreachable:place@5", "reject:arm_trajectory@3", "reject:joint_states@3"),
    *("cancel:move@6", "cancel:move@3.moving", "second_commander:arm_trajectory@4.moving", "skip_cycles@2"),
    *("second_commander:arm_trajectory@3.moving", "switch:arm_trajectory@3", "stick:arm_shoulder_pan_joint@3"),
    *("stick:gripper_robotiq_85_left_knuckle_joint@6", "slow:gripper_robotiq_85_left_knuckle_joint@4.moving"),
    *("displace:gripper_robotiq_85_left_knuckle_joint@3", "protective_stop:arm@5.moving", "emergency_stop:arm@3"),
    *("protective_stop:gripper@4.moving", "restart_driver:arm@3.moving", "cut_network:camera@4.moving"),
    *("program_pause:arm@2", "stale_set_points:arm@3", "lose_part:gripper@5.moving", "missing_part:object@3"),
)
"""Runs of the campaign of ur5e_pick: each kind of fault, at steps of each kind."""

LAYER_OF = {
    AttemptOutcome.SUCCEEDED: Layer.NONE,
    AttemptOutcome.CANCELED: Layer.CANCEL,
    AttemptOutcome.STALE_STATE: Layer.STALE,
    AttemptOutcome.TF_FAILURE: Layer.TF,
    AttemptOutcome.PLANNING_FAILURE: Layer.PLANNING,
    AttemptOutcome.GOAL_REJECTION: Layer.REJECTION,
    AttemptOutcome.TOLERANCE_VIOLATION: Layer.TOLERANCE,
    AttemptOutcome.GRIP_FAILURE: Layer.GRIP,
    AttemptOutcome.MISSED_CYCLE: Layer.CYCLE,
    AttemptOutcome.PROTECTIVE_STOP: Layer.STOP,
    AttemptOutcome.EMERGENCY_STOP: Layer.STOP,
    AttemptOutcome.HARDWARE_FAULT: Layer.STOP,
    AttemptOutcome.WRONG_OWNER: Layer.OWNER,
    AttemptOutcome.CLAIM_FAILURE: Layer.OWNER,
    AttemptOutcome.UNCOMMANDED_MOTION: Layer.OWNER,
    AttemptOutcome.TIMEOUT: Layer.TIMEOUT,
}
"""The layer of each outcome that the mock tells apart."""


def evidence(folder: Path, cell: str, *words: str) -> dict[str, tuple[Path, list[dict[str, Any]]]]:
    """Run the mock; return the bag and the records of each run, by the name of its file."""
    ran = run(words[0], generated(cell).as_posix(), *words[1:], "--evidence", folder.as_posix())
    assert ran.code == 0, ran.out + ran.err
    records = {file.name.removesuffix(".records.jsonl"): file for file in folder.glob("*.records.jsonl")}
    return {
        name: (folder / f"{name}.mcap", [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()])
        for name, file in sorted(records.items())
    }


def differences(bag: Path, records: list[dict[str, Any]], cell: str, task: str) -> Iterator[str]:
    """Yield each field that is neither the mock's nor UNKNOWN, and a layer that is another than the mock's outcome."""
    folder = read_folder(generated(cell))
    report = read_attempt([bag], folder.contract, folder.rehearsals, folder.watches, task)
    attempts = json.loads(to_json(report))["attempts"]
    if len(attempts) != len(records):
        yield f"{len(attempts)} attempts for {len(records)}"
    for ours, theirs in zip(attempts, records, strict=False):
        for name, value in theirs.items():
            if name not in ("attempt_id", "rehearsal"):  # are named after the bag, and after the task
                yield from _difference(f"{theirs['step']}, {name}", name, ours, value)
    layer = "none" if report.end.finding is None else report.end.finding.layer.value
    expected = LAYER_OF[AttemptOutcome(records[-1]["outcome"])].value
    if layer != expected:
        yield f"layer {layer}, expected {expected}"


def _difference(place: str, name: str, ours: dict[str, Any], theirs: Any) -> Iterator[str]:
    mine = ours[name]
    if isinstance(mine, dict) and isinstance(theirs, dict):  # a part of it may be UNKNOWN for itself
        codes = {"result.error_code", "result.error_string"}  # they travel in a service
        assert name != "result" or codes <= ours["unknown"].keys()
        known = [part for part in theirs if f"{name}.{part}" not in ours["unknown"]]
        mine, theirs = ({part: each[part] for part in known} for each in (mine, theirs))
    if name == "trace" and isinstance(mine, list):  # the mock forgets joint states after some seconds, a bag does not
        mine = [point for point in mine if point in theirs or name not in ours["unknown"]]
        mine, theirs = ([point for point in each if point in theirs] for each in (mine, theirs))
    if mine != UNKNOWN and mine != theirs and name not in ours["unknown"]:
        yield f"{place}: {mine}, expected {theirs}"


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_records_of_every_rehearsal_are_the_same(cell: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    found = {}
    every = [entry.name for entry in read_folder(generated(cell)).rehearsals]
    wanted = [word for name in sample(request, every, _SHARE) for word in ("--rehearsal", name)]
    for name, (bag, records) in evidence(tmp_path / "evidence", cell, "mock", *wanted).items():
        if records:  # a cell that was never brought up made no attempt
            found[name] = list(differences(bag, records, cell, name))
    assert found
    assert {name: problems for name, problems in found.items() if problems} == {}


def test_records_and_layers_of_faulty_runs_are_the_same(request: pytest.FixtureRequest, tmp_path: Path) -> None:
    runs = [f"pick_and_place/{fault}" for fault in sample(request, FAULTS, _SHARE)]
    made = evidence(tmp_path / "evidence", "ur5e_pick", "replay", *runs)
    assert len(made) == len(runs)
    found = {
        name: list(differences(bag, records, "ur5e_pick", "pick_and_place")) for name, (bag, records) in made.items()
    }
    assert {name: problems for name, problems in found.items() if problems} == {}
