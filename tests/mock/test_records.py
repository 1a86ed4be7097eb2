"""Attempt records: the fields of the checkpoint, and the same bytes from every run."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from cellc.contract.attempt import PacketStep
from cellc.mock import MockCell, to_json_lines
from tests.cells import ROOT

# Chapter 4, "Manufacturing Cell Checkpoint": what every attempt logs.
CHECKPOINT = [
    "attempt_id",
    "version_tuple",
    "calibration_id",
    "goal_frame",
    "goal_stamp",
    "joint_state_age",
    "tf_lookup_age",
    "plan_result",
    "controller_name",
    "action_goal_id",
    "speed_scaling",
    "safety_state",
    "fault_code",
    "cancel",
    "result",
    "operator_intervention",
]


def test_every_record_has_every_field_of_the_checkpoint(cell: MockCell) -> None:
    for name in cell.rehearsals:
        for line in to_json_lines(cell.run(name).attempts).splitlines():
            assert set(CHECKPOINT) <= set(json.loads(line))


def test_fields_that_the_contract_asks_for_are_recorded(cell: MockCell) -> None:
    record = json.loads(to_json_lines(cell.run("canceled").attempts).splitlines()[0])
    for field in cell.contract.attempt_fields:
        assert set(field.split("/")) <= set(record)


def test_goal_on_an_observed_frame_names_the_calibrations_it_rests_on(cell: MockCell) -> None:
    attempts = {attempt.step: attempt for attempt in cell.run("pick_and_place").attempts}
    # The camera's mount and the TCP were measured; the fixture was, and the way to it leads over no camera.
    assert attempts["move pick"].calibration_id == ("hand_eye:4", "tcp_2f:1")
    assert attempts["move place"].calibration_id == ("fixture_a:2", "tcp_2f:1")
    assert attempts["move home"].calibration_id == ()


def test_packet_is_traced_through_all_eight_steps_in_order(cell: MockCell) -> None:
    pick = next(attempt for attempt in cell.run("pick_and_place").attempts if attempt.step == "move pick")
    assert [point.step for point in pick.trace] == list(PacketStep)
    stamps = [point.stamp_ns for point in pick.trace]
    assert stamps == sorted(stamps)


def test_goal_stamp_is_that_of_the_image_and_its_ages_follow(cell: MockCell) -> None:
    attempts = {attempt.step: attempt for attempt in cell.run("pick_and_place").attempts}
    detected, pick = attempts["detect object"], attempts["move pick"]
    # Perception looks every 100 ms at the newest image, which left the shutter 8 ms + 5 ms before it arrived, and
    # needs 20 ms; images start every 1/30 s.
    latest_look_ns = (detected.ended_ns - 20_000_000) // 100_000_000 * 100_000_000
    newest_image = (latest_look_ns - 13_000_000) * 30 // 1_000_000_000
    assert detected.goal_stamp == round(newest_image * 1e9 / 30)
    assert pick.goal_stamp == detected.goal_stamp
    assert pick.tf_lookup_age is not None
    transformed_ns = pick.trace[1].stamp_ns
    assert pick.tf_lookup_age == (transformed_ns - pick.goal_stamp) / 1e9


def test_records_are_the_same_to_the_byte_in_two_processes(built_folder: Path, tmp_path: Path) -> None:
    written = []
    for seed in ("1", "4242"):
        file = tmp_path / seed
        command = [sys.executable, "-m", "cellc.mock", str(built_folder), "--records", str(file)]
        subprocess.run(command, cwd=ROOT, env=os.environ | {"PYTHONHASHSEED": seed}, check=True, capture_output=True)
        written.append(file.read_bytes())
    assert written[0] == written[1]
    assert written[0].count(b"\n") == 60


def test_another_seed_gives_other_goal_ids_and_the_same_seed_the_same(cell: MockCell) -> None:
    def goal_ids(seed: int) -> list[str | None]:
        return [attempt.action_goal_id for attempt in cell.run("canceled", seed=seed).attempts]

    assert goal_ids(7) == goal_ids(7)
    assert goal_ids(7) != goal_ids(8)


def test_order_of_rehearsals_does_not_matter(cell: MockCell) -> None:
    first = to_json_lines(cell.run("canceled").attempts)
    cell.run("pick_and_place")
    cell.run("stale_camera")
    assert to_json_lines(cell.run("canceled").attempts) == first
