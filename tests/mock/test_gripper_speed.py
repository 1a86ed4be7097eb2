"""A gripper closes as fast as its device does, unless the spec says how fast its joint is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cellc.compiler.emit.contract.devices import devices
from cellc.contract.devices import ContractSimulatedJoint
from cellc.mock import MockCell, load
from cellc.mock.cell import cell_of
from tests.cells import compiled, generated, spec_text, written

_JOINT = "gripper_robotiq_85_left_knuckle_joint"
_CLOSES_S = 0.085 / 0.150
"""Robotiq 2F-85 datasheet: a stroke of 85 mm at up to 150 mm/s."""
_LOOKED_AT_S = 1.0 / 20.0
"""Default of `action_monitor_rate` of parallel_gripper_action_controller, with which it tells of success."""


def _took_s(cell: MockCell, step: str) -> float:
    (done,) = [attempt for attempt in cell.run("ready").attempts if attempt.step == step]
    return (done.ended_ns - done.started_ns) / 1e9


def test_jaws_close_at_the_speed_of_the_datasheet() -> None:
    took = _took_s(load(generated("minimal")), "grip close gripper")
    assert _CLOSES_S - 0.01 < took < _CLOSES_S + 3 * _LOOKED_AT_S


def test_speed_that_the_spec_states_counts_before_that_of_the_device() -> None:
    folder = load(generated("minimal")).folder
    stated = {_JOINT: ContractSimulatedJoint(max_velocity=0.2)}
    slow = replace(folder, contract=folder.contract.model_copy(update={"simulated_joints": stated}))
    # 0.7929 rad at 0.2 rad/s, less the tolerance of 0.01 rad.
    assert 3.9 < _took_s(cell_of(slow), "grip close gripper") < 4.2


def test_least_cell_moves_its_arm() -> None:
    assert _took_s(load(generated("minimal")), "move aside") > 0.1


def test_jaws_close_at_the_speed_and_with_the_force_of_the_grip(tmp_path: Path) -> None:
    text, model = spec_text("minimal"), "model: robotiq_2f_85\n"
    assert text.count(model) == 1
    graph = compiled(
        written(tmp_path, text.replace(model, f"{model}    grip: {{speed: 50 mm/s, force: 40 N}}\n"))
    ).graph
    gripper = devices(graph.cell)["gripper"].gripper
    assert gripper is not None
    assert gripper.max_effort == 40.0
    # 0.7929 rad in 85 mm at 50 mm/s.
    assert gripper.max_velocity == pytest.approx(0.7929 / 0.085 * 0.05, rel=1e-3)
