"""A state in which hardware comes up, where the cell states another than follows from its vendor's facts."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cellc.mock.cell import load
from tests.cells import Compiled, build_into, compiled, spec_text, written
from tests.foreign_yaml import safe_load


@pytest.fixture(scope="module")
def spec(tmp_path_factory: pytest.TempPathFactory) -> Path:
    text = spec_text("minimal").replace("model: ur5e\n", "model: ur5e\n    initial_state: inactive\n", 1)
    return written(tmp_path_factory.mktemp("inactive"), text)


@pytest.fixture(scope="module")
def built(spec: Path) -> Compiled:
    return compiled(spec)


def test_the_controller_manager_is_told_both_lists(built: Compiled) -> None:
    # ros2_control, controller_manager userdoc: hardware_components_initial_state; what no list names comes up active.
    manager = safe_load(built.texts["config/controllers.yaml"])["controller_manager"]["ros__parameters"]
    assert manager["hardware_components_initial_state"] == {
        "unconfigured": ["gripper_hardware"],
        "inactive": ["arm_hardware"],
    }


def test_the_stated_state_is_observed_before_a_person_activates_it(built: Compiled) -> None:
    states = json.loads(built.texts["config/observe.json"])["real"]["states"]["/controller_manager"]["hardware"]
    assert states == {"arm_hardware": "inactive", "gripper_hardware": "unconfigured"}


def test_a_person_activates_it_before_anything_claims(built: Compiled) -> None:
    steps = json.loads(built.texts["config/bring_up.json"])["real"]
    asked = [(step["phase"], step["request"].get("component")) for step in steps if step["request"]]
    assert ("activate", "arm_hardware") in asked
    assert asked.index(("activate", "arm_hardware")) < next(at for at, one in enumerate(asked) if one[0] == "claim")


def test_the_mock_brings_it_up_from_there_and_moves(spec: Path, tmp_path: Path) -> None:
    result = load(build_into(tmp_path / "cell", spec)).run("ready")
    assert result.outcome == "succeeded"
