"""No controller is activated before an interface that it needs exists: the real controller manager would refuse it.

A component exports its interfaces from its configuration on. Without any, joint_state_broadcaster ends its activation
with an error (ros2_controllers 5.17.0, `on_activate`); every other controller is refused where one of its own is
missing. What exists when is read from the generated files alone: parameters, URDF, contract and plan.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from tests.cells import CELLS, CORPUS, DISTROS, EVERY_CELL, built, graph_of, spec_text, written
from tests.emit.cells import artifacts_of, emitted_graph
from tests.foreign_yaml import safe_load

_EVERY = os.environ.get("CELLC_TEST_CELLS") == "every"
_OWN = [(cell, "") for cell in EVERY_CELL]
_OTHERS = [(cell, distro) for cell in (EVERY_CELL if _EVERY else CELLS) for distro in DISTROS]
_CORPUS = [(spec, "") for spec in ("complete", "two_arms", "hanging_camera", "several_switches", "every_target")]


@cache
def _files(cell: str, distro: str) -> Mapping[str, str]:
    if distro:
        return artifacts_of(cell, distro)
    return built(cell).texts if cell in EVERY_CELL else emitted_graph(graph_of(CORPUS / "valid" / f"{cell}.yaml"))


@dataclass
class _Manager:
    """What a controller manager has after each step: the interfaces of the components that are configured."""

    components: dict[str, frozenset[str]]
    exported: set[str]

    def configure(self, component: str) -> None:
        self.exported.add(component)

    @property
    def interfaces(self) -> frozenset[str]:
        return frozenset[str]().union(*(self.components[name] for name in self.exported if name in self.components))


def _managers(files: Mapping[str, str], contract: Any, target: str) -> dict[str, _Manager]:
    """Return the managers by the names of their nodes, as they have come up."""
    urdf = contract["files"].get(f"urdf_{target}") or f"urdf/{contract['cell']}.{target}.urdf"
    described = _components(files[urdf])
    found = {}
    for name, facts in contract["managers"].items():
        node = f"{facts['namespace']}/controller_manager"
        parameters = safe_load(files[contract["files"]["parameters"][name]])
        initial = _initial(parameters, node)
        started = set(described) - set(initial.get("unconfigured", ()))
        found[node] = _Manager(described, started)
    return found


def _initial(parameters: Any, node: str) -> Any:
    for key in (node, node.lstrip("/"), node.rpartition("/")[2]):
        if key in parameters:
            return parameters[key]["ros__parameters"].get("hardware_components_initial_state", {})
    raise AssertionError(f"no parameters of {node} in {list(parameters)}")


def _components(urdf: str) -> dict[str, frozenset[str]]:
    found = {}
    for component in ElementTree.fromstring(urdf).iterfind("ros2_control"):
        parts = [part for tag in ("joint", "sensor", "gpio") for part in component.iterfind(tag)]
        names = [
            f"{part.get('name')}/{interface.get('name')}"
            for part in parts
            for tag in ("command_interface", "state_interface")
            for interface in part.iterfind(tag)
        ]
        found[component.get("name", "")] = frozenset(names)
    return found


def _refused(files: Mapping[str, str], target: str) -> Iterator[str]:
    """Yield what the controller manager would refuse in the plan of a target."""
    contract = json.loads(files["contract.json"])
    managers = _managers(files, contract, target)
    controllers = {
        (f"{facts['namespace']}/controller_manager", name): controller
        for facts in contract["managers"].values()
        for name, controller in facts["controllers"].items()
    }
    for step in json.loads(files[contract["files"]["bring_up"]])[target]:
        asked = step.get("request") or {}
        if asked.get("kind") == "hardware":
            managers[asked["manager"]].configure(asked["component"])
        if asked.get("kind") not in ("controllers", "restart"):
            continue
        exported = managers[asked["manager"]].interfaces
        described = frozenset[str]().union(*managers[asked["manager"]].components.values())
        for name in asked["controllers"]:
            controller = controllers[asked["manager"], name]
            needs = {*controller.get("command_interfaces", ()), *controller.get("state_interfaces", ())}
            if target == "real":  # what a vendor's plugin exports beside its description, it exports with that
                device = contract["devices"].get(controller.get("device"), {})
                own = device.get("hardware_component") in managers[asked["manager"]].exported
                needs = {name for name in needs if name in described or not own}
            missing = sorted(needs - exported)
            if missing or not exported:
                yield f"{step['name']}: {name} needs {missing or 'any interface'}"


@pytest.mark.parametrize("target", ["mock", "real"])
@pytest.mark.parametrize(("cell", "distro"), [*_OWN, *_OTHERS, *_CORPUS])
def test_each_controller_finds_its_interfaces(cell: str, distro: str, target: str) -> None:
    assert list(_refused(_files(cell, distro), target)) == []


@pytest.mark.parametrize(("cell", "devices"), [("openarm_bimanual", ("left", "right")), ("hybrid_sdk", ("gripper",))])
def test_what_reads_hardware_that_a_person_activates_is_activated_after_it(cell: str, devices: tuple[str, ...]) -> None:
    plan = json.loads(_files(cell, "")["config/bring_up.json"])
    for target in ("mock", "real"):
        steps = {step["name"]: step for step in plan[target]}
        activating = [name for name, step in steps.items() if step["phase"] == "activate"]
        assert activating == [f"{verb}" for device in devices for verb in _steps_of(device)]
        assert (steps["observe_control"].get("request"), steps["observe_control"].get("effect", [])) == (None, [])


def _steps_of(device: str) -> tuple[str, str]:
    return f"activate_{device}", f"observe_{device}_again"


def test_plan_that_reads_nothing_yet_is_told() -> None:
    files = dict(_files("openarm_bimanual", ""))
    plan = json.loads(files["config/bring_up.json"])
    observed = next(step for step in plan["real"] if step["name"] == "observe_left_again")
    plan["real"].remove(observed)
    plan["real"].insert(0, observed)
    files["config/bring_up.json"] = json.dumps(plan)
    assert list(_refused(files, "real")) == ["observe_left_again: joint_states needs any interface"]


def test_node_that_needs_a_transform_over_joints_waits_for_their_hardware(tmp_path: Path) -> None:
    """The wrist camera of ur5e_pick hangs on the arm: while the arm is unconfigured, nobody knows where it is."""
    text = spec_text("ur5e_pick")
    arm = "    architecture: hybrid       # the servo loop stays in the vendor controller\n"
    assert text.count(arm) == 1
    files = emitted_graph(graph_of(written(tmp_path, text.replace(arm, f"{arm}    initial_state: unconfigured\n"))))
    for target in ("mock", "real"):
        phases = {step["name"]: step["phase"] for step in json.loads(files["config/bring_up.json"])[target]}
        own = {
            step["name"]: step["phase"] for step in json.loads(_files("ur5e_pick", "")["config/bring_up.json"])[target]
        }
        assert (own["activate_perception"], phases["activate_perception"]) == ("start", "activate")
        assert list(phases).index("activate_perception") > list(phases).index("observe_arm_again")
        assert list(_refused(files, target)) == []
    real = json.loads(files["config/observe.json"])["real"]
    assert real["lifecycle"] == {"/perception": "inactive"}
    assert real["states"]["/controller_manager"]["controllers"]["joint_states"] == "inactive"
    assert real["ends"]["/joint_states"]["sources"] == {"/joint_states": "G5"}
    enabled = files["gates/promotion.md"].split("\n## G5")[1].split("\n## ")[0]
    assert "Check that `/joint_states` arrives at 500 Hz, at most 5 % less" in enabled
