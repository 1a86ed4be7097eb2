"""The steps of the bring-up: what they wait for exists, and they do nothing before it shows, whoever is first."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path
from xml.etree.ElementTree import fromstring

import pytest

from tests.consumers.launch_interpreter import Command
from tests.consumers.matrix import HERE, build, every_build
from tests.consumers.starting import activated, bring_ups, commands, moves, written, written_managers
from tests.emit.cells import contract_data
from tests.foreign_yaml import safe_load

_FILE = "launch/bring_up.bash"
_CONDITION = re.compile(r"^    needs (.+)$", re.MULTILINE)


def steps(cell: str, distro: str) -> dict[str, str]:
    """Return the text of every step by its name."""
    text = build(cell, distro).texts[_FILE]
    return dict(re.findall(r"^  (\w+)\) # .*\n((?:    (?!;;).*\n)+)", text, re.MULTILINE))


@every_build
def test_script_is_bash_and_launching_starts_every_step(cell: str, distro: str) -> None:
    text = build(cell, distro).texts[_FILE]
    subprocess.run(["bash", "-n"], input=text, text=True, check=True, capture_output=True)
    built = build(cell, distro)
    started = [one for target in ("mock", "real") for one in commands(cell, distro, target)]
    assert all(one.words == ("bash", _FILE, one.name) for one in started)
    prefixes = [one.prefix for target in ("mock", "real") for one in moves(built, target)]
    assert all(prefix[:2] == ("bash", _FILE) for prefix in prefixes)
    assert {one.name for one in started} | {prefix[2] for prefix in prefixes} == set(steps(cell, distro))


@every_build
def test_conditions_name_what_the_cell_has(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    contract = contract_data(texts["contract.json"])
    frames = set(safe_load(texts["config/frames.yaml"])["frames"])
    controllers = {
        (f"{manager['namespace']}/controller_manager", one["full_name"].rpartition("/")[2])
        for manager in contract["managers"].values()
        for one in manager["controllers"].values()
    }
    managed = {f"/{name}" for name, node in written(cell).get("nodes", {}).items() if node.get("lifecycle")}
    kinds = {name: one["kind"] for name, one in contract["interfaces"].items()}
    for condition in _CONDITION.findall(texts[_FILE]):
        kind, *named = condition.split()
        if kind == "controller":
            assert (named[0], named[1]) in controllers
            assert named[2] in ("inactive", "active")
        elif kind in ("topic", "action"):
            assert kinds[named[0]] == kind
        elif kind == "transform":
            assert set(named) <= frames
        else:
            assert kind == "mocked" or named[0] in managed, condition


@every_build
def test_mover_of_the_mock_looks_at_the_description_of_every_manager(cell: str, distro: str) -> None:
    # Each host is started with a target of its own, so that one manager may run the mock and another a robot.
    managers = [namespace for namespace, _ in written_managers(cell)]
    alone = f"/{'robot_state' if len(managers) == 1 else 'description'}_publisher"
    asked = "/controller_manager" if distro == "humble" else alone
    step = steps(cell, distro).get("move_mock", "")
    assert re.findall(r"needs mocked (\S+)\n", step) == ([f"{one}{asked}" for one in managers] if step else [])


@every_build
def test_everything_is_activated_once_and_alternates_never(cell: str, distro: str) -> None:
    for target in ("mock", "real"):
        for namespace, manager in written_managers(cell):
            spawned = _spawned(cell, distro, target, namespace)
            wanted = [n for n, one in manager["controllers"].items() if one.get("active", True) and n in spawned]
            assert sorted(activated(cell, distro, target, f"{namespace}/controller_manager")) == sorted(wanted)


def _spawned(cell: str, distro: str, target: str, namespace: str) -> set[str]:
    lines = [
        one.arguments
        for launch in bring_ups(build(cell, distro), target)
        for one in launch.processes
        if one.executable == "spawner" and f"{namespace}/controller_manager" in one.arguments
    ]
    return {name for line in lines for name in line[: line.index("-c")]}


@every_build
def test_policy_lets_the_steps_ask_and_act(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    (path,) = re.findall('^enclave="(.+?)"', texts[_FILE], re.MULTILINE)
    policy = fromstring(texts["security/policy.xml"])
    (enclave,) = [one for one in policy.iter("enclave") if one.attrib["path"] == path]
    may = {entry.text for profile in enclave.iter("profile") for kind in profile for entry in kind}
    for kind, *named in (condition.split() for condition in _CONDITION.findall(texts[_FILE])):
        if kind == "topic":
            assert named[0] in may
        elif kind == "controller":
            assert {f"{named[0]}/{one}" for one in ("list_controllers", "switch_controller")} <= may
        elif kind == "lifecycle":
            assert {f"{named[0]}/{one}" for one in ("get_state", "change_state", "get_available_transitions")} <= may
        elif kind == "mocked":
            assert f"{named[0]}/get_parameters" in may
    assert {"/tf", "/tf_static"} <= may
    # To wait is not to move: neither a goal nor a command may come from here.
    assert not [kind for profile in enclave.iter("profile") for kind in profile if kind.tag == "actions"]


class Stack:
    """A graph of one managed node and three controllers, as the pick cell has them, behind a `ros2` of our own."""

    def __init__(self, folder: Path) -> None:
        self.state = folder / "state"
        for name in ("nodes", "controllers", "refuses"):
            (self.state / name).mkdir(parents=True)
        (self.state / "log").touch()
        (self.state / "actions").write_text("/move_action\n/gripper_action/gripper_cmd\n")
        (self.state / "description").mkdir()
        (self.state / "description" / "robot_state_publisher").write_text(
            "<plugin>mock_components/GenericSystem</plugin>"
        )
        tools = folder / "bin"
        tools.mkdir()
        (tools / "ros2").write_text((HERE / "fake_ros2.bash").read_text(encoding="utf-8"))
        (tools / "sleep").write_text("#!/bin/sh\nexec /bin/sleep 0.05\n")
        for tool in tools.iterdir():
            tool.chmod(0o755)
        (folder / "bring_up.bash").write_text(build("ur5e_pick", "jazzy").texts[_FILE])
        self.script = folder / "bring_up.bash"
        self.environment = os.environ | {"PATH": f"{tools}:{os.environ['PATH']}", "STATE": str(self.state)}

    def start(self, *words: str, wait_s: int = 20) -> subprocess.Popen[str]:
        return subprocess.Popen(
            ["bash", str(self.script), *words],
            env=self.environment | {"CELL_WAIT_S": str(wait_s)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def spawn(self) -> None:
        for name in ("joint_states", "arm_trajectory", "gripper_action"):
            (self.state / "controllers" / name).write_text("inactive\n")

    @property
    def log(self) -> list[str]:
        return (self.state / "log").read_text().splitlines()


def _bring_up() -> list[Command]:
    return list(commands("ur5e_pick", "jazzy", "mock"))


def test_steps_started_in_the_wrong_order_act_in_the_right_one(tmp_path: Path) -> None:
    stack = Stack(tmp_path)
    started = [stack.start(step.name) for step in reversed(_bring_up())]
    stack.spawn()
    (stack.state / "nodes" / "perception").write_text("unconfigured\n")
    for process in started:
        _, errors = process.communicate(timeout=60)
        assert process.returncode == 0, errors
    log = stack.log
    assert sorted(log[:2]) == ["claim joint_states", "configure /perception"]  # neither waits for the other
    assert log[2:] == ["activate /perception", "claim arm_trajectory", "claim gripper_action"]


@pytest.mark.parametrize("missing", ["spawner", "perception"])
def test_nothing_is_claimed_without_proof_and_the_missing_proof_is_named(tmp_path: Path, missing: str) -> None:
    stack = Stack(tmp_path)
    if missing != "spawner":
        stack.spawn()
        (stack.state / "refuses" / "perception").touch()
    (stack.state / "nodes" / "perception").write_text("unconfigured\n")
    ended = {step.name: stack.start(step.name, wait_s=2) for step in _bring_up()}
    errors = {name: process.communicate(timeout=60)[1] for name, process in ended.items()}
    assert ended["claim_control"].returncode == 1
    assert "claim arm_trajectory" not in stack.log
    condition = (
        "controller /controller_manager arm_trajectory inactive"
        if missing == "spawner"
        else "lifecycle /perception active"
    )
    assert errors["claim_control"].strip().endswith(f"there is no {condition}")


@pytest.mark.parametrize("target", ["mock", "real"])
def test_mover_of_the_mock_is_not_started_on_real_hardware(tmp_path: Path, target: str) -> None:
    stack = Stack(tmp_path)
    stack.spawn()
    for name in ("arm_trajectory", "gripper_action"):
        (stack.state / "controllers" / name).write_text("active\n")
    (stack.state / "nodes" / "perception").write_text("active\n")
    if target == "real":
        plugins = "<plugin>mock_components/GenericSystem</plugin><plugin>a_driver/Hardware</plugin>"
        (stack.state / "description" / "robot_state_publisher").write_text(plugins)
    mover = stack.start("move_mock", "echo", "it moves", wait_s=1)
    said, _ = mover.communicate(timeout=60)
    assert ("it moves" in said) is (target == "mock")
    assert mover.returncode == (0 if target == "mock" else 1)


def test_mover_waits_for_its_claims(tmp_path: Path) -> None:
    stack = Stack(tmp_path)
    stack.spawn()
    (stack.state / "nodes" / "perception").write_text("active\n")
    said, errors = stack.start("move_real", "echo", "it moves", wait_s=1).communicate(timeout=60)
    assert "it moves" not in said
    assert "there is no controller /controller_manager arm_trajectory active" in errors


def test_mover_starts_on_real_hardware_once_everything_shows(tmp_path: Path) -> None:
    stack = Stack(tmp_path)
    stack.spawn()
    (stack.state / "nodes" / "perception").write_text("active\n")
    mover = stack.start("move_real", "echo", "it moves")
    for name in ("arm_trajectory", "gripper_action"):
        (stack.state / "controllers" / name).write_text("active\n")
    said, errors = mover.communicate(timeout=60)
    assert (said.splitlines()[-1], mover.returncode, errors) == ("it moves", 0, "")
