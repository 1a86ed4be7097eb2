"""The generated folder as a whole: headers, references, what may not stand in it."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import Rehearsals
from tests.cells import ROOT, spec_text
from tests.emit.cells import CELLS, artifacts_of, emitted


@pytest.mark.parametrize("cell", CELLS)
def test_every_file_names_its_command_and_the_configuration_stands_where_it_is_looked_for(cell: str) -> None:
    artifacts = artifacts_of(cell)
    identity = json.loads(artifacts["contract.json"])["configuration_id"]
    assert re.fullmatch(r"cfg-[0-9a-f]{12}", identity)
    # manifest.json holds it too, and is taken over these.
    assert {path for path, text in artifacts.items() if identity in text} == {"contract.json"}
    for path, text in artifacts.items():
        if not path.endswith(".json"):
            head = "\n".join(text.splitlines()[:9])
            assert f"cellc build cells/{cell}/cell.yaml" in head, path


@pytest.mark.parametrize("cell", CELLS)
def test_no_file_holds_a_date_of_its_making_or_a_path_of_the_host(cell: str, tmp_path: Path) -> None:
    for path, text in emitted(tmp_path, spec_text(cell)).items():
        assert str(tmp_path) not in text, path
        assert str(ROOT) not in text, path
        assert text.endswith("\n"), path
        assert "\r" not in text, path
        assert not re.search(r"[ \t]$", text, re.MULTILINE), path


def test_artifacts_are_the_same_wherever_the_spec_lies(tmp_path: Path) -> None:
    other = tmp_path / "elsewhere"
    other.mkdir()
    assert emitted(tmp_path, spec_text("minimal")) == emitted(other, spec_text("minimal"))


def test_artifacts_are_the_same_under_any_hash_seed() -> None:
    script = (
        "import hashlib; from tests.emit.cells import artifacts_of;"
        "print(hashlib.sha256(repr(sorted(artifacts_of('ur5e_pick').items())).encode()).hexdigest())"
    )
    runs = [
        subprocess.run([sys.executable, "-c", script], cwd=ROOT, env={"PYTHONHASHSEED": seed}, capture_output=True)
        for seed in ("1", "4242")
    ]
    assert runs[0].stdout == runs[1].stdout
    assert len(runs[0].stdout) == 65, runs[0].stderr


@pytest.mark.parametrize("cell", CELLS)
def test_launch_refers_to_files_of_the_package(cell: str) -> None:
    artifacts = artifacts_of(cell)
    text = artifacts["launch/cell.launch.xml"]
    paths = set(re.findall(rf"\$\(find-pkg-share {cell}\)/((?:\$\(var (?:target|stage)\)|[^\"') ])+)", text))
    assert paths
    for path in paths:
        for target in re.findall(r'<choice value="(mock|sim|real)"/>', text):
            for stage in ("10", "25", "50", "100"):
                assert path.replace("$(var target)", target).replace("$(var stage)", stage) in artifacts


def test_mock_target_starts_no_driver_and_real_target_needs_a_person() -> None:
    launch = ElementTree.fromstring(artifacts_of("ur5e_pick")["launch/cell.launch.xml"])
    only_real = "$(eval \"'$(var target)' == 'real'\")"
    only_mock, only_sim = (only_real.replace("real", target) for target in ("mock", "sim"))
    drivers = {"ur_robot_driver", "realsense2_camera"}
    assert {node.get("if") for node in launch.findall("node") if node.get("pkg") in drivers} == {only_real}
    started = {node.get("args", "").split(" --target ")[-1]: node for node in launch.findall("node")}
    assert started["real start"].get("if") == only_real
    assert started["mock start activate claim"].get("if") == only_mock
    assert started["sim start activate claim"].get("if") == only_sim
    spawners = [node for node in launch.findall("node") if node.get("exec") == "spawner"]
    assert [(node.get("if"), node.get("unless")) for node in spawners] == [
        (None, only_sim),
        (only_real, None),
        (only_sim, None),
    ]
    assert spawners[1].get("args", "").startswith("arm_io ")  # what the mock lacks
    kept = {*drivers, "ur5e_pick"}
    others = [node for node in launch.findall("node") if node.get("pkg") not in kept and node not in spawners]
    managers = [node for node in others if node.get("exec") == "ros2_control_node"]
    assert [(node.get("pkg"), node.get("if"), node.get("unless")) for node in managers] == [
        ("controller_manager", None, only_sim),
        ("mujoco_ros2_control", only_sim, None),
    ]
    assert {node.get("if") for node in others if node not in managers} == {None}
    gate = next(argument for argument in launch.findall("arg[@name='confirm_real']") if argument.get("if") == only_real)
    assert gate.get("default") is None
    assert len(gate.findall("choice")) == 1


def test_launch_arguments_are_described_and_target_is_mock_by_default() -> None:
    launch = ElementTree.fromstring(artifacts_of("ur5e_pick")["launch/cell.launch.xml"])
    arguments = {argument.attrib["name"]: argument for argument in launch.findall("arg") if argument.get("if") is None}
    assert sorted(arguments) == ["arm_address", "confirm_real", "headless", "stage", "target"]
    assert all(argument.get("description") for argument in arguments.values())
    assert arguments["target"].get("default") == "mock"
    assert [choice.get("value") for choice in arguments["target"].findall("choice")] == ["mock", "sim", "real"]


def test_alternates_are_configured_and_not_activated(tmp_path: Path) -> None:
    # Observed: a second claimant fails.
    text = spec_text("minimal").replace(
        "    gripper_action:",
        "    arm_forward: {type: forward_command, device: arm, active: false}\n    gripper_action:",
    )
    artifacts = emitted(tmp_path, text)
    launch = ElementTree.fromstring(artifacts["launch/cell.launch.xml"])
    spawners = [node.get("args") for node in launch.findall("node") if node.get("exec") == "spawner"]
    assert spawners == [
        "joint_states arm_trajectory arm_forward gripper_action -c /controller_manager --inactive",
        "arm_io -c /controller_manager --inactive",  # on the real target alone
    ]
    plan = json.loads(artifacts["config/bring_up.json"])
    requests = [step["request"] for step in plan["mock"] if "request" in step]
    activated = [request["controllers"] for request in requests if request["kind"] == "controllers"]
    assert activated == [["joint_states"], ["arm_trajectory", "gripper_action"]]


@pytest.mark.parametrize("cell", CELLS)
def test_contract_and_rehearsals_are_what_the_mock_reads(cell: str) -> None:
    artifacts = artifacts_of(cell)
    contract = Contract.model_validate_json(artifacts["contract.json"])
    assert set(contract.files.parameters.values()) <= set(artifacts)
    assert {contract.files.urdf_mock, contract.files.urdf_real, contract.files.rehearsals} <= set(artifacts)
    assert contract.files.srdf in artifacts
    Rehearsals.model_validate_json(artifacts[contract.files.rehearsals])


def test_contract_says_what_the_spec_says() -> None:
    contract = Contract.model_validate_json(artifacts_of("ur5e_pick")["contract.json"])
    assert contract.interfaces["/object_pose"].max_age_s == 0.2
    assert contract.interfaces["/object_pose"].on_stale == "reject_goal"
    assert contract.joint_limits["arm_elbow_joint"].acceleration == 2.5  # 50 % of 5 rad/s^2
    assert contract.groups["manipulator"].controller == "arm_trajectory"
    assert contract.frames["object"].pose is None
    assert contract.frames["fixture_A"].calibration == "fixture_a"
    assert contract.devices["camera"].camera is not None
    assert contract.devices["camera"].camera.exposure_s == 0.008
    assert contract.kpis.cancel_s == 0.2
    assert len(contract.attempt_fields) == 15  # the checkpoint of chapter 4 names fifteen


@pytest.mark.parametrize("cell", CELLS)
def test_launch_file_starts_one_publisher_of_the_robot_state(cell: str) -> None:
    launch = ElementTree.fromstring(artifacts_of(cell)["launch/cell.launch.xml"])
    hosts = [include.attrib["file"] for include in launch.iter("include")]
    parts = [launch, *(ElementTree.fromstring(artifacts_of(cell)[path]) for path in _parts(cell, hosts))]
    started = [
        node.attrib for part in parts for node in part.iter("node") if node.get("pkg") == "robot_state_publisher"
    ]
    assert [node["exec"] for node in started] == ["robot_state_publisher"]


def _parts(cell: str, included: list[str]) -> list[str]:
    return [path for path in artifacts_of(cell) if any(file.endswith(f"/{path}") for file in included)]
