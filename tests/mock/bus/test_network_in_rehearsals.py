"""What the contract says of the network happens in a rehearsal, and stands in its findings."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cellc.contract.rehearsals import FaultEntry
from cellc.mock import MockCell, RehearsalResult, load
from cellc.mock.bus.network import QosEventKind
from cellc.mock.plant import Plant

Change = Callable[[dict[str, Any]], None]


def cell_with(folder: Path, change: Change) -> MockCell:
    """Load the cell with its contract changed."""
    file = folder / "contract.json"
    contract = json.loads(file.read_text())
    change(contract)
    file.write_text(json.dumps(contract))
    return load(folder, edited=True)


def run(cell: MockCell, seed: int = 0) -> tuple[RehearsalResult, Plant]:
    plants: list[Plant] = []
    return cell.rehearse(cell.entry("pick_and_place"), seed=seed, watch=plants.append), plants[0]


def carried(topic: str, **figures: float) -> Change:
    def change(contract: dict[str, Any]) -> None:
        contract["interfaces"][topic]["simulated"] = figures

    return change


def profile(topic: str, **policies: Any) -> Change:
    """Change the profile of every end of a topic."""

    def change(contract: dict[str, Any]) -> None:
        for end in (*contract["interfaces"][topic]["sources"], *contract["interfaces"][topic]["sinks"]):
            end["qos"] |= policies

    return change


def test_images_that_are_lost_are_counted(folder: Path) -> None:
    result, plant = run(cell_with(folder, carried("/camera/color/image_raw", latency_s=0.002, loss=0.2)))
    lost = plant.network.events.total(QosEventKind.MESSAGE_LOST, "/camera/color/image_raw", "perception")
    sent = round(plant.now_ns * 30 / 1e9)  # 30 images a second
    assert lost == pytest.approx(0.2 * sent, abs=4.0 * (0.16 * sent) ** 0.5)
    assert f"`/camera/color/image_raw` at `perception`: message lost, {lost} x" in result.findings


def test_images_that_take_too_long_are_stale(folder: Path) -> None:
    result, _ = run(cell_with(folder, carried("/camera/color/image_raw", latency_s=0.15)))  # 0.1 s are allowed
    assert result.outcome == "stale_state"


def test_joint_states_that_take_too_long_are_stale(folder: Path) -> None:
    result, _ = run(cell_with(folder, carried("/joint_states", latency_s=0.15)))  # 0.1 s are allowed
    assert result.outcome == "stale_state"
    assert result.attempts[0].fault_code.startswith("joint state is 0.15")


def test_ages_of_joint_states_tell_of_the_way(folder: Path) -> None:
    result, _ = run(cell_with(folder, carried("/joint_states", latency_s=0.02)))
    assert result.outcome == "succeeded"
    assert result.attempts[0].joint_state_age == pytest.approx(0.02, abs=0.0021)


def test_joint_states_survive_a_lossy_network_of_a_fast_stream(folder: Path) -> None:
    result, _ = run(cell_with(folder, carried("/joint_states", loss=0.05, jitter_s=0.001)))
    assert result.outcome == "succeeded"


def test_transforms_that_do_not_arrive_are_a_tf_failure(folder: Path) -> None:
    def change(contract: dict[str, Any]) -> None:
        carried("/tf", loss=1.0)(contract)
        profile("/tf", reliability="best_effort")(contract)

    result, _ = run(cell_with(folder, change))
    assert result.outcome in ("bringup_failure", "tf_failure")


def test_transforms_are_as_late_as_the_network_makes_them(folder: Path) -> None:
    result, plant = run(cell_with(folder, carried("/tf", latency_s=0.05)))
    assert result.outcome == "succeeded"
    newest_ns = plant.task.buffer.latest_ns("world", "object")
    assert newest_ns is not None
    assert plant.now_ns - newest_ns >= 50_000_000


def test_deadline_that_the_camera_keeps_is_not_told(folder: Path) -> None:
    result, _ = run(cell_with(folder, profile("/camera/color/image_raw", deadline_s=0.04)))
    assert result.findings == ()


def test_deadline_that_the_camera_misses_is_told_of_both_ends(folder: Path) -> None:
    result, _ = run(cell_with(folder, profile("/camera/color/image_raw", deadline_s=0.03)))  # it comes every 33 ms
    assert result.outcome == "succeeded"  # a deadline reports a missed contract, it enforces nothing
    assert any("at `camera`: offered deadline missed" in finding for finding in result.findings)
    assert any("at `perception`: requested deadline missed" in finding for finding in result.findings)


def test_deadline_that_joint_states_keep_is_not_told(folder: Path) -> None:
    result, _ = run(cell_with(folder, profile("/joint_states", deadline_s=0.002)))  # 500 Hz
    assert result.findings == ()


def test_deadline_that_joint_states_miss_is_told_of_every_end(folder: Path) -> None:
    cell = cell_with(folder, profile("/joint_states", deadline_s=0.01))
    entry = cell.entry("pick_and_place")
    late = FaultEntry(kind="skip_cycles", target="", at_s=0.2, cycles=12)
    result = cell.rehearse(entry.model_copy(update={"faults": (late,)}))
    # 12 cycles of 2 ms are missed: 26 ms between two samples hold two periods of 10 ms that pass without one.
    for node, kind in (
        ("joint_states", "offered deadline missed"),
        ("robot_state_publisher", "requested deadline missed"),
        ("move_group", "requested deadline missed"),
        ("task", "requested deadline missed"),
    ):
        assert f"`/joint_states` at `{node}`: {kind}, 2 x" in result.findings


def test_seed_of_the_run_decides_what_is_lost(folder: Path) -> None:
    cell = cell_with(folder, carried("/camera/color/image_raw", loss=0.3))
    first, again, other = run(cell, 1)[0], run(cell, 1)[0], run(cell, 2)[0]
    assert first == again
    assert first.findings != other.findings
