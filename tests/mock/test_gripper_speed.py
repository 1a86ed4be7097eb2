"""A gripper closes as fast as its device does, unless the spec says how fast its joint is."""

from __future__ import annotations

from dataclasses import replace

from cellc.contract.devices import ContractSimulatedJoint
from cellc.mock import MockCell, load
from cellc.mock.cell import cell_of
from tests.cells import generated

_JOINT = "gripper_robotiq_85_left_knuckle_joint"
_CLOSES_S = 0.085 / 0.150
"""Robotiq 2F-85 datasheet: a stroke of 85 mm at up to 150 mm/s."""
_LOOKED_AT_S = 1.0 / 20.0
"""Default of `action_monitor_rate` of parallel_gripper_action_controller, with which it tells of success."""


def _took_s(cell: MockCell, step: str) -> float:
    (done,) = [one for one in cell.run("ready").attempts if one.step == step]
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
