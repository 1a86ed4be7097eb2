"""The generated folder of the real cell and its evidence, built once; copies with other rehearsals; readers of bags."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml

from cellc.mock import MockCell, load
from cellc.mock.command.rehearsals import begin_evidence
from cellc.mock.result import RehearsalResult
from tests.cells import generated
from tests.foreign_yaml import safe_load

Fault = dict[str, Any]
LoadWith = Callable[..., MockCell]


def fault(kind: str, target: str, at_s: float, **more: float) -> Fault:
    """Return an entry of rehearsals.json."""
    return {"kind": kind, "target": target, "at_s": at_s, **more}


@pytest.fixture(scope="session")
def built_folder() -> Path:
    """The folder of cells/ur5e_pick; never changed."""
    return generated("ur5e_pick")


@pytest.fixture
def folder(built_folder: Path, tmp_path: Path) -> Path:
    """A copy of the folder that a test may spoil."""
    return Path(shutil.copytree(built_folder, tmp_path / "ur5e_pick"))


@pytest.fixture(scope="session")
def cell(built_folder: Path) -> MockCell:
    """The loaded cell as it was built."""
    return load(built_folder)


@pytest.fixture
def load_with(folder: Path) -> LoadWith:
    """Load the cell with one rehearsal: the steps of pick_and_place, and the faults given."""

    def build(*faults: Fault, **changes: Any) -> MockCell:
        file = folder / "rehearsals.json"
        rehearsals = json.loads(file.read_text())
        plain = next(entry for entry in rehearsals["rehearsals"] if entry["name"] == "pick_and_place")
        rehearsals["rehearsals"] = [plain | {"name": "faulty", "faults": list(faults)} | changes]
        file.write_text(json.dumps(rehearsals))
        return load(folder, edited=True)

    return build


@pytest.fixture
def edit_contract(folder: Path) -> Callable[[Callable[[Any], None]], MockCell]:
    """Change contract.json by a function on its JSON, and load."""

    def edit(change: Callable[[Any], None]) -> MockCell:
        file = folder / "contract.json"
        contract = json.loads(file.read_text())
        change(contract)
        file.write_text(json.dumps(contract))
        return load(folder, edited=True)

    return edit


@pytest.fixture
def two_managers(folder: Path) -> MockCell:
    """The cell with its gripper under a manager of its own, at half the rate."""
    contract = json.loads((folder / "contract.json").read_text())
    arm = contract["managers"]["control"]
    gripper = {"gripper_action": arm["controllers"].pop("gripper_action")}
    states = {"gripper_states": arm["controllers"]["joint_states"]}
    contract["managers"]["grip"] = arm | {"namespace": "/grip", "controllers": states | gripper}
    path = contract["files"]["parameters"]["control"]
    parameters = safe_load((folder / path).read_text())
    plugins = parameters["controller_manager"]["ros__parameters"]
    own = {
        "update_rate": 250,
        "gripper_states": plugins["joint_states"],
        "gripper_action": plugins.pop("gripper_action"),
    }
    sections = {
        "/grip/controller_manager": {"ros__parameters": own},
        "/grip/gripper_action": parameters.pop("gripper_action"),
    }
    contract["files"]["parameters"]["grip"] = "grip.yaml"
    (folder / path).write_text(yaml.safe_dump(parameters))
    (folder / "grip.yaml").write_text(yaml.safe_dump(sections))
    (folder / "contract.json").write_text(json.dumps(contract))
    _plan_for_two(folder / contract["files"]["bring_up"])
    return load(folder, edited=True)


def _plan_for_two(file: Path) -> None:
    """Have the plan of the bring-up ask the manager of the gripper for what is the gripper's."""
    plan = json.loads(file.read_text())
    file.write_text(json.dumps(plan | {target: _steps_for_two(plan[target]) for target in ("mock", "real")}))


def _steps_for_two(told: list[Any]) -> list[Any]:
    steps = []
    for step in told:
        for part in ("proof", "effect"):
            step[part] = [one for one in step.get(part, []) if one.get("controller") != "gripper_action"]
            for one in step[part]:
                if one.get("component") == "gripper_hardware":
                    one["manager"] = "/grip/controller_manager"
        request = step.get("request") or {}
        if request.get("component") == "gripper_hardware":
            request["manager"] = "/grip/controller_manager"
        for name, own in (("gripper_action", "gripper_action"), ("joint_states", "gripper_states")):
            if request.get("kind") == "controllers" and name in request["controllers"]:
                request["controllers"] = [
                    controller for controller in request["controllers"] if controller != "gripper_action"
                ]
                asked = {"kind": "controllers", "manager": "/grip/controller_manager", "controllers": [own]}
                steps.append(step | {"request": asked, "effect": []})
        if request.get("kind") != "restart":
            steps.append(step)
    return sorted(steps, key=lambda one: one["phase"] != "activate")


@dataclass(frozen=True)
class Written:
    """An evidence folder with the results that the runs returned."""

    folder: Path
    results: dict[str, RehearsalResult]

    def bag(self, rehearsal: str) -> Path:
        return self.folder / f"{rehearsal}.mcap"


@dataclass(frozen=True)
class Received:
    """A message as an independent reader decoded it."""

    log_ns: int
    message: Any


def write_evidence(cell: MockCell, folder: Path, *names: str, seed: int = 0) -> Written:
    chosen = names or cell.rehearsals
    with begin_evidence(cell, folder, chosen, seed) as collector:
        results = {name: collector.run(name) for name in chosen}
        collector.settle()
    return Written(folder, results)


@pytest.fixture(scope="session")
def written(cell: MockCell, tmp_path_factory: pytest.TempPathFactory) -> Written:
    """Evidence of every rehearsal of the cell; never changed."""
    return write_evidence(cell, tmp_path_factory.mktemp("evidence") / "runs")


def received(bag: Path, topic: str) -> Iterator[Received]:
    """Read a topic with rosbags, which knows the types from the definitions in the bag alone."""
    from rosbags.highlevel import AnyReader

    with AnyReader([bag]) as reader:
        connections = [connection for connection in reader.connections if connection.topic == topic]
        assert connections, f"{topic} is not in the bag"
        for connection, log_ns, data in reader.messages(connections):
            yield Received(log_ns, reader.deserialize(data, connection.msgtype))


def stamp_ns(header: Any) -> int:
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)
