"""Caps in the parameters that run: shares of the limits before them, given last, chosen by the launch."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import yaml

from tests.cells import CORPUS, EVERY_CELL, built, compiled, spec_text, written

WHOLE = "commissioning: {velocity: 100 %, acceleration: 100 %}"
CAPPED = [cell for cell in EVERY_CELL if cell != "minimal"]
STAGE = "$(find-pkg-share {})/config/commissioning/stage_$(var stage).yaml"


def parameters(texts: Mapping[str, str], path: str) -> dict[str, Any]:
    """Return the parameters of a file for every node, by an independent reader."""
    told = yaml.safe_load(texts[path])["/**"]["ros__parameters"]
    assert isinstance(told, dict)
    return told


@pytest.mark.parametrize("cell", CAPPED)
@pytest.mark.parametrize(("percent", "share"), [(10, 0.1), (25, 0.25), (50, 0.5), (100, 1.0)])
def test_file_of_a_stage_has_its_share_of_every_limit(cell: str, percent: int, share: float) -> None:
    texts = built(cell).texts
    capped = parameters(texts, f"config/commissioning/stage_{percent}.yaml")["robot_description_planning"]
    whole = parameters(texts, "config/joint_limits.yaml")["robot_description_planning"]["joint_limits"]
    assert capped["joint_limits"].keys() == whole.keys()
    for joint, limits in capped["joint_limits"].items():
        for of in ("velocity", "acceleration"):
            assert limits[f"has_{of}_limits"] is True
            assert limits[f"max_{of}"] == pytest.approx(share * whole[joint][f"max_{of}"])
    linear = parameters(texts, "config/moveit/move_group.yaml")["robot_description_planning"]["cartesian_limits"]
    assert capped["cartesian_limits"] == pytest.approx({name: share * value for name, value in linear.items()})


@pytest.mark.parametrize("cell", CAPPED)
def test_move_group_is_given_the_stage_last_wherever_it_is_started(cell: str) -> None:
    launches = [text for path, text in built(cell).texts.items() if path.endswith(".launch.xml")]
    planners = [node for text in launches for node in ElementTree.fromstring(text).iterfind("node[@exec='move_group']")]
    assert planners
    for node in planners:
        assert [param.get("from") for param in node.iterfind("param[@from]")][-1] == STAGE.format(cell)


@pytest.mark.parametrize("cell", CAPPED)
def test_real_hardware_starts_in_the_first_stage_and_the_mock_in_the_last(cell: str) -> None:
    texts, real = built(cell).texts, "$(eval \"'$(var target)' == 'real'\")"
    launch = ElementTree.fromstring(texts["launch/cell.launch.xml"])
    first, last = launch.iterfind("arg[@name='stage']")
    assert (first.get("default"), first.get("if")) == ("10", real)
    assert (last.get("default"), set(last.attrib)) == ("100", {"name", "default", "description"})
    for argument in (first, last):
        assert [choice.get("value") for choice in argument] == ["10", "25", "50", "100"]
    for include in launch.iterfind("include"):
        assert {arg.get("name"): arg.get("value") for arg in include}["stage"] == "$(var stage)"
        path = str(include.get("file")).rpartition(")/")[2]
        assert len(list(ElementTree.fromstring(texts[path]).iterfind("arg[@name='stage']"))) == 2


def test_servo_has_its_scales_capped_and_the_file_last() -> None:
    texts = compiled(CORPUS / "valid" / "servo_and_octomap.yaml").texts
    whole = parameters(texts, "config/moveit/servo.yaml")["moveit_servo"]["scale"]
    capped = parameters(texts, "config/commissioning/stage_25.yaml")["moveit_servo"]["scale"]
    assert capped == pytest.approx({name: 0.25 * value for name, value in whole.items()})
    (launch,) = (text for path, text in texts.items() if path == "launch/move.launch.xml")
    (node,) = (node for node in ElementTree.fromstring(launch).iterfind("node") if node.get("pkg") == "moveit_servo")
    assert str([param.get("from") for param in node.iterfind("param[@from]")][-1]).endswith("stage_$(var stage).yaml")
    assert len(list(ElementTree.fromstring(launch).iterfind("arg[@name='stage']"))) == 2


def test_caps_of_a_cell_are_in_its_files_its_contract_and_its_gates(tmp_path: Path) -> None:
    stated = "commissioning: {velocity: 0.5 m/s, acceleration: 40 %, reach: 0.9 m, force: 60 N, stages: 20 100 %}"
    text = (
        spec_text("ur5e_pick")
        .replace(WHOLE, stated)
        .replace("max_delta: 5 deg, velocity: 5 deg/s", "max_delta: 1 deg, velocity: 1 deg/s")
    )
    assessed = "  risk_assessment: {document: RA-017 rev 2, velocity: 500 mm/s}\n\nbringup:"
    texts = compiled(written(tmp_path, text.replace("\nbringup:", assessed, 1))).texts
    assert {path for path in texts if "commissioning" in path} == {
        "config/commissioning/stage_20.yaml",
        "config/commissioning/stage_100.yaml",
    }
    first = parameters(texts, "config/commissioning/stage_20.yaml")["robot_description_planning"]
    # 20 % of the 0.25 m/s that straight lines have anyway, which is below the 0.5 m/s of the cap; 8 % of 0.5 m/s^2.
    assert first["cartesian_limits"] == pytest.approx(
        {"max_trans_vel": 0.05, "max_trans_acc": 0.04, "max_trans_dec": -0.04, "max_rot_vel": 0.1}
    )
    assert '"max_effort": 60.0' in texts["contract.json"]
    gates = texts["gates/promotion.md"]
    assert "Stage 20 % of commissioning" in gates
    assert "Stage 100 %: Start only if the previous stage is signed and ran without a stop" in gates
    assert "do not exceed those of RA-017 rev 2: tool speed 500 mm/s" in gates
    audit = texts["audit.md"]
    assert "| 20 % | manipulator 0.1 m/s | 0.05 m/s |" in audit
    assert "Reach 0.9 m: poses and goals are checked." in audit
    assert "Not capped: a goal that a client sends directly to /arm_trajectory/follow_joint_trajectory" in audit


def test_cell_without_a_planner_has_no_stage() -> None:
    texts = built("minimal").texts
    assert not [path for path in texts if "commissioning" in path]
    assert "stage" not in texts["launch/cell.launch.xml"]
