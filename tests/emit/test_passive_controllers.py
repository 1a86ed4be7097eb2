"""Controllers that only a vendor has and that move no joint: claims, parameters, rights, targets, and the mock."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.etree import ElementTree

import pytest

from cellc.compiler.catalog.load import load_device
from cellc.contract.vocabulary import Distro
from cellc.mock.control import ControllerManager, DeclaredInterfaces
from tests.cells import diagnose, spec_text
from tests.consumers.permissions import policy_of
from tests.emit.cells import contract_data, emitted
from tests.foreign_yaml import safe_load
from tests.oracles.parameters import declarations

SCALING = "      scaling: {type: speed_scaling_state_broadcaster, device: arm}\n"
ACTIVATION = "      activation: {type: gripper_activation, device: gripper, client: task}\n"


def _arm_and_gripper(more: str = SCALING.replace("      ", "    ") + ACTIVATION.replace("      ", "    ")) -> str:
    return spec_text("ur5e_pick").replace("  controllers:\n", f"  controllers:\n{more}", 1)


@lru_cache(maxsize=2)
def _artifacts(cell: str) -> dict[str, str]:
    text = _arm_and_gripper()
    if cell == "fr3_hand":
        text = spec_text(cell)  # it has the broadcaster of its arm
    with TemporaryDirectory() as folder:
        return emitted(Path(folder), text)


def _controllers(cell: str) -> dict[str, Any]:
    (manager,) = contract_data(_artifacts(cell)["contract.json"])["managers"].values()
    controllers: dict[str, Any] = manager["controllers"]
    return controllers


def _spawners(cell: str) -> list[ElementTree.Element]:
    files = [text for path, text in _artifacts(cell).items() if path.startswith("launch/") and path.endswith(".xml")]
    nodes = [node for text in files for node in ElementTree.fromstring(text).iter("node")]
    return [node for node in nodes if node.get("exec") == "spawner"]


def test_broadcaster_reads_what_it_publishes_and_drives_nothing() -> None:
    scaling = _controllers("ur5e_pick")["scaling"]
    assert scaling["behavior"] == "broadcaster"
    assert scaling["state_interfaces"] == ["arm_speed_scaling/speed_scaling_factor"]
    assert scaling["command_interfaces"] == scaling["joints"] == []
    assert scaling["targets"] == ["mock", "real"]


def test_service_claims_interfaces_of_its_device_on_real_hardware_alone() -> None:
    # robotiq_activation_controller.cpp: two names in its code, which no prefix reaches; so the tag has them too.
    activation = _controllers("ur5e_pick")["activation"]
    assert activation["targets"] == ["real"]
    claimed = [f"reactivate_gripper/reactivate_gripper_{name}" for name in ("cmd", "response")]
    assert activation["command_interfaces"] == claimed
    robot = ElementTree.fromstring(_artifacts("ur5e_pick")["urdf/ur5e_pick.real.urdf"])
    offered = {f"{gpio.get('name')}/{one.get('name')}" for gpio in robot.iter("gpio") for one in gpio}
    assert set(claimed) <= offered


def test_each_target_spawns_what_it_has() -> None:
    lists = {node.attrib["args"].split(" -c ")[0]: node.attrib for node in _spawners("ur5e_pick")}
    both, real, sim = (
        "scaling joint_states arm_trajectory gripper_action arm_speed",
        "activation arm_io arm_tcp arm_software",
        "joint_states arm_trajectory gripper_action",
    )
    assert set(lists) == {both, real, sim}
    assert "sim" in lists[both]["unless"]
    assert "real" in lists[real]["if"]
    assert "sim" in lists[sim]["if"]
    alone = {node.attrib["args"].split(" -c ")[0]: node.attrib for node in _spawners("fr3_hand")}
    assert "if" in alone["arm_state"]
    assert "mock" in alone["hand_action"]["if"]


def test_parameters_are_given_in_the_types_that_the_vendor_declares() -> None:
    sections = safe_load(_artifacts("ur5e_pick")["config/controllers.yaml"])
    assert sections["scaling"]["ros__parameters"] == {"state_publish_rate": 100.0, "tf_prefix": "arm_"}
    state = safe_load(_artifacts("fr3_hand")["config/controllers.real.yaml"])["arm_state"]["ros__parameters"]
    assert state == {"arm_prefix": "", "convenience_publish_rate": 1000, "robot_type": "fr3"}


def test_declared_parameters_are_those_of_the_vendor() -> None:
    declared = declarations("speed_scaling_state_broadcaster", "jazzy")
    device = load_device("ur5e").value
    assert device is not None
    own = device.model.controllers["speed_scaling_state_broadcaster"].parameters
    assert {name: (facts.type, facts.default) for name, facts in own.items()} == {
        name: (entry["type"], entry["default_value"]) for name, entry in declared.items()
    }


@pytest.mark.parametrize(
    ("written", "code"),
    [("state_publish_rat: 50.0", "unknown-controller-parameter"), ("state_publish_rate: 50", "wrong-parameter-type")],
)
def test_written_parameters_are_held_against_the_declared_ones(written: str, code: str, tmp_path: Path) -> None:
    scaling = f"    scaling: {{type: speed_scaling_state_broadcaster, device: arm, parameters: {{{written}}}}}\n"
    file = tmp_path / "cell.yaml"
    file.write_text(_arm_and_gripper(scaling), encoding="utf-8")
    found = [diagnosis for diagnosis in diagnose(file) if diagnosis.code == code]
    assert [finding.yaml_path[:3] for finding in found] == [("control", "controllers", "scaling")]


def test_second_claimant_of_a_service_is_reported(tmp_path: Path) -> None:
    twice = "".join(f"    {name}: {{type: gripper_activation, device: gripper, client: task}}\n" for name in ("a", "b"))
    file = tmp_path / "cell.yaml"
    file.write_text(_arm_and_gripper(twice), encoding="utf-8")
    assert "double-claim" in {diagnosis.code for diagnosis in diagnose(file)}


def test_topics_and_services_are_promised_and_permitted() -> None:
    interfaces = contract_data(_artifacts("ur5e_pick")["contract.json"])["interfaces"]
    assert interfaces["/scaling/speed_scaling"]["type"] == "std_msgs/msg/Float64"
    asked = interfaces["/activation/reactivate_gripper"]
    assert [end["full_name"] for end in asked["sinks"]] == ["/task"]
    assert asked["sources"][0]["targets"] == ["real"]
    policy = policy_of(_artifacts("ur5e_pick"))
    profiles = {profile.get("node"): profile for profile in policy.iter("profile")}
    assert "/scaling/speed_scaling" in [entry.text for entry in profiles["scaling"].iter("topic")]
    callers = {
        name
        for name, profile in profiles.items()
        for entry in profile.findall("services[@request='ALLOW']/service")
        if entry.text == "/activation/reactivate_gripper"
    }
    assert callers == {"task"}


def test_mock_runs_a_broadcaster_on_what_it_reads_and_refuses_what_it_has_not() -> None:
    artifacts, controllers = _artifacts("ur5e_pick"), _controllers("ur5e_pick")
    manager = ControllerManager(
        artifacts["urdf/ur5e_pick.mock.urdf"],
        artifacts["config/controllers.yaml"],
        distro=Distro.JAZZY,
        plugin_behaviors=contract_data(artifacts["contract.json"])["plugin_behaviors"],
        declared={
            name: DeclaredInterfaces(tuple(one["command_interfaces"]), tuple(one["state_interfaces"]))
            for name, one in controllers.items()
        },
    )
    assert manager.spawn(["scaling"]).ok
    manager.advance(20_000_000)
    (listed,) = manager.list_controllers()
    assert (listed.name, listed.state, listed.claimed_interfaces) == ("scaling", "active", ())
    assert listed.required_state_interfaces == ("arm_speed_scaling/speed_scaling_factor",)
    assert manager.state("arm_speed_scaling/speed_scaling_factor") == 1.0
    # Its interfaces are those of real hardware: the mock refuses it as the real manager would.
    assert not manager.spawn(["activation"]).ok
