"""What nobody says of a device's coming up is not taken for harmless."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.diagnostics import Severity
from tests.cells import CORPUS, Compiled, compiled, written
from tests.foreign_yaml import safe_load

_SPEC = """format: 1
cell: silent
versions: {ros: jazzy}
devices:
  it: {model: ./device, mount: {parent: world}}
control:
  update_rate: 500 Hz
  controllers:
    joint_states: {type: joint_state_broadcaster}
    moves: {type: joint_trajectory, device: it, goal_time: 1 s, path_tolerance: 0.2 rad, goal_tolerance: 0.01 rad}
"""


@pytest.fixture(scope="module")
def spec(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("silent")
    shutil.copytree(CORPUS / "invalid/base/silent_arm", folder / "device")
    return written(folder, _SPEC)


@pytest.fixture(scope="module")
def built(spec: Path) -> Compiled:
    return compiled(spec)


def test_a_blocker_says_that_nobody_knows_what_its_activation_moves(spec: Path) -> None:
    found = [diagnostic for diagnostic in check(spec).diagnostics if diagnostic.code == "unknown-activation"]
    assert [(finding.severity, finding.span.line) for finding in found] == [(Severity.BLOCKER, 5)]
    assert "the activation of `it`" in found[0].message


def test_its_component_comes_up_unconfigured_and_a_person_activates_it(built: Compiled) -> None:
    manager = safe_load(built.texts["config/controllers.yaml"])["controller_manager"]["ros__parameters"]
    assert manager["hardware_components_initial_state"] == {"unconfigured": ["it_hardware"]}
    real = json.loads(built.texts["config/bring_up.json"])["real"]
    activating = [step for step in real if (step.get("request") or {}).get("kind") == "hardware"]
    assert [(step["phase"], step["request"]["component"]) for step in activating] == [("activate", "it_hardware")]
    early = [proof for step in real if step["phase"] == "start" for proof in step["proof"]]
    assert "it_hardware" not in {proof.get("component") for proof in early}
    assert "confirm_activation" in built.texts["launch/activate.launch.xml"]


def test_the_audit_asks_its_supplier(built: Compiled) -> None:
    (line,) = (line for line in built.texts["audit.md"].splitlines() if "What moves or falls" in line)
    assert "supplier nobody" in line
    assert "the activation of silent" in line.replace("\\_", "_")
