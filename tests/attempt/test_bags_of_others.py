"""Bags that rosbags wrote, of known outcome: the layer, the eight steps and the figures are those that were put in."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from rosbags.rosbag2 import StoragePlugin

from tests.attempt.hand_made import (
    ABORTED,
    BEGIN_NS,
    CANCELED,
    FINGER,
    JOINTS,
    MOVE,
    MS,
    PLAN,
    HandMade,
    arrived,
    attempted,
    moving,
    protective_stop,
)


def read(*bags: Path, task: str | None = None) -> dict[str, Any]:
    """Return the report."""
    ran = attempted(*bags, task=task)
    assert ran.err == "", ran.err
    report = json.loads(ran.out)
    assert ran.code == (0 if report["outcome"] == "succeeded" else 1)
    return dict(report)


@pytest.mark.parametrize("plugin", StoragePlugin, ids=lambda plugin: str(plugin.name).lower())
def test_protective_stop_is_the_layer_whatever_the_storage(tmp_path: Path, plugin: StoragePlugin) -> None:
    report = read(protective_stop().write(tmp_path / "stop", plugin))
    finding = report["attempts"][-1]["finding"]
    assert finding["layer"] == "stop"
    assert finding["at_ns"] == BEGIN_NS + 600 * MS
    assert finding["message"] == "/arm_io/safety_mode of arm: mode is 3"
    assert report["outcome"] == "UNKNOWN"  # protective, safeguard or violation: the contract has no name for 3
    assert "safety_state" in report["attempts"][0]["unknown"]


def test_steps_and_times_of_a_move_are_those_of_the_messages(tmp_path: Path) -> None:
    report = read(arrived().write(tmp_path / "good"), task="canceled")
    first = report["attempts"][0]
    assert (first["step"], first["outcome"], first["safety_state"]) == ("move home", "succeeded", "normal")
    assert {point["step"][0]: (point["stamp_ns"] - BEGIN_NS) // MS for point in first["trace"]} == {
        "3": 150,
        "4": 150,
        "5": 150,
        "6": 152,
        "7": 162,
        "8": 500,
    }
    assert (first["started_ns"] - BEGIN_NS, first["ended_ns"] - BEGIN_NS) == (100 * MS, 505 * MS)
    assert first["joint_state_age"] == 0.0
    assert first["action_goal_id"] == "02020202-0202-0202-0202-020202020202"
    figures = {figure["name"]: figure["value"] for figure in report["figures"]}
    assert figures["plan_to_execute_s"] == pytest.approx(0.012)
    assert figures["cancel_s"] is None


def test_parts_of_a_split_bag_are_one_attempt(tmp_path: Path) -> None:
    bag, whole = arrived(), read(arrived().write(tmp_path / "whole"))
    middle = len(bag.messages) // 2
    parts = bag.write(tmp_path / "a", end=middle), bag.write(tmp_path / "b", begin=middle)
    joined = read(*parts)
    assert joined["messages"] == whole["messages"]
    for ours, theirs in zip(joined["attempts"], whole["attempts"], strict=True):
        assert {**ours, "attempt_id": ""} == {**theirs, "attempt_id": ""}


def test_cancel_is_timed_from_the_request_to_standstill(tmp_path: Path) -> None:
    bag = HandMade()
    for _ in moving(bag, 900 * MS, lambda at_ns: 0.5 if 160 * MS < at_ns <= 540 * MS else 0.0):
        pass
    bag.begin_move()
    bag.end_move(560 * MS, CANCELED, canceled_ns=500 * MS)
    report = read(bag.write(tmp_path / "cancel"))
    first = report["attempts"][0]
    assert first["finding"]["layer"] == "canceled by a client"
    assert first["cancel"]["requested_ns"] == BEGIN_NS + 500 * MS
    assert first["cancel"]["held_ns"] == BEGIN_NS + 540 * MS
    assert first["cancel"]["latency_s"] == pytest.approx(0.04)


def test_joint_states_that_stop_are_stale_state(tmp_path: Path) -> None:
    bag = HandMade()
    for _ in moving(bag, 400 * MS, lambda at_ns: 0.5 if at_ns > 160 * MS else 0.0):
        pass
    bag.begin_move()
    bag.end_move(610 * MS, CANCELED, canceled_ns=600 * MS)
    finding = read(bag.write(tmp_path / "frozen"))["attempts"][-1]["finding"]
    assert finding["layer"] == "stale state"
    assert finding["message"] == "joint state is 0.202 s old, 0.100 s allowed"


def test_tolerance_is_the_words_of_the_controller(tmp_path: Path) -> None:
    bag = arrived()
    bag.messages = [each for each in bag.messages if each[1] not in (MOVE, PLAN)]
    bag.begin_move()
    bag.says(499 * MS, "arm_trajectory", "-5: goal tolerance violated by wrist_3")
    bag.goal(500 * MS, MOVE, 2, 150 * MS, ABORTED)
    report = read(bag.write(tmp_path / "tolerance"))
    finding = report["attempts"][-1]["finding"]
    assert (finding["layer"], finding["source"]) == ("tolerance", "/rosout")
    assert finding["message"] == "arm_trajectory: -5: goal tolerance violated by wrist_3"
    assert report["outcome"] == "tolerance_violation"


def test_a_bag_that_lacks_topics_says_what_to_record(tmp_path: Path) -> None:
    bag = arrived()
    bag.messages = [each for each in bag.messages if each[1] == MOVE]
    report = read(bag.write(tmp_path / "few"))
    assert {"/joint_states", "/rosout", "/tf", "/diagnostics", PLAN} <= set(report["missing_topics"])
    unknown = report["attempts"][0]["unknown"]
    assert "status of the planning action" in unknown["joint_state_age"]
    assert "joint states" in unknown["trace"]


def test_joints_of_another_cell_are_refused_by_name(tmp_path: Path) -> None:
    bag = arrived()
    bag.messages = [each for each in bag.messages if each[1] == MOVE]
    bag.joints(10 * MS, [0.0] * 7, (*(f"left_{joint}" for joint in JOINTS), FINGER))
    ran = attempted(bag.write(tmp_path / "other"))
    assert ran.code == 2
    assert "its joint states must have `arm_elbow_joint`, got `left_arm_elbow_joint`" in ran.err


def test_a_bag_without_an_action_of_the_cell_is_refused(tmp_path: Path) -> None:
    bag = HandMade()
    bag.joints(0, [0.0] * 7)
    ran = attempted(bag.write(tmp_path / "none"))
    assert ran.code == 2
    assert "is no bag of ur5e_pick: expected `/arm_trajectory/follow_joint_trajectory/_action/status`" in ran.err


def test_hostile_texts_stay_on_their_line(tmp_path: Path) -> None:
    bag = protective_stop()
    bag.messages = [each for each in bag.messages if each[1] != "/arm_io/safety_mode"]
    bag.says(701 * MS, "arm_trajectory", "x\x1b[2J\r\n::error::| `a` <script>alert(1)</script>\u202e")
    folder = bag.write(tmp_path / "hostile")
    for form in ("text", "markdown", "json"):
        ran = attempted(folder, form=form)
        assert ran.code == 1
        for mark in ("\x1b", "\r", "\u202e"):
            assert mark not in ran.out + ran.err
        assert not any(line.startswith("::") for line in ran.out.splitlines())
