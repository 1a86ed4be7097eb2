"""One release of a person moves one device: each activation and each claim of an arm has a word of its own."""

from __future__ import annotations

import json
from xml.etree import ElementTree

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.bringup import bring_up
from cellc.contract.bring_up import LifecycleProof, Transition
from tests.cells import CORPUS, EVERY_CELL, built, graph_of
from tests.emit.cells import unbroken

_WORDS = {
    "activate": "I_HAVE_PASSED_GATES_G0_TO_G4_AND_THE_AREA_IS_EMPTY",
    "claim": "I_HAVE_PASSED_GATES_G0_TO_G6",
}
# By the devices of each spec: OpenArm's arms and Robotiq's gripper move as they are activated; what an arm carries is
# claimed with it. No hardware for
# real of rail_arm has the rail, so that nothing claims there.
_RELEASES: dict[str, dict[str, tuple[str, ...]]] = {
    "dual_ur": {"claim": ("loader", "unloader")},
    "fr3_hand": {"claim": ("",)},
    "gen3_2f": {"claim": ("",)},
    "hybrid_sdk": {"activate": ("",), "claim": ("",)},
    "minimal": {"activate": ("",), "claim": ("",)},
    "openarm_bimanual": {"activate": ("left", "right"), "claim": ("left", "right")},
    "rail_arm": {},
    "ur5e_pick": {"activate": ("",), "claim": ("",)},
}
_CLAIMS = {
    ("openarm_bimanual", "left"): {"left_trajectory", "left_gripper"},
    ("openarm_bimanual", "right"): {"right_trajectory", "right_gripper"},
    ("dual_ur", "loader"): {"loader_trajectory"},
    ("dual_ur", "unloader"): {"unloader_trajectory"},
    ("ur5e_pick", "arm"): {"arm_trajectory", "gripper_action"},
}


def test_every_cell_is_listed() -> None:
    assert set(_RELEASES) == set(EVERY_CELL)


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_each_device_has_a_word_and_a_process_of_its_own(cell: str) -> None:
    texts = built(cell).texts
    for phase, word in _WORDS.items():
        path = f"launch/{phase}.launch.xml"
        assert (path in texts) is (phase in _RELEASES[cell])
        if path not in texts:
            continue
        launch = ElementTree.fromstring(texts[path])
        (argument,) = launch.findall("arg")
        words = {name: f"{word}_FOR_{name}" if name else word for name in _RELEASES[cell][phase]}
        assert "default" not in argument.attrib
        assert [choice.attrib["value"] for choice in argument.findall("choice")] == list(words.values())
        for name, node in zip(_RELEASES[cell][phase], launch.findall("node"), strict=True):
            released = f"--release {name} " if name else ""
            assert node.attrib["args"].endswith(f"--target real {released}{phase}")
            said = f"$(eval \"'$(var {argument.attrib['name']})' == '{words[name]}'\")" if name else None
            assert node.attrib.get("if") == said


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_no_step_of_a_release_touches_the_device_of_another(cell: str) -> None:
    texts = built(cell).texts
    contract = json.loads(texts["contract.json"])
    components = {name: device.get("hardware_component") for name, device in contract["devices"].items()}
    for step in json.loads(texts["config/bring_up.json"])["real"]:
        asked = step.get("request") or {}
        if step["phase"] == "activate" and asked.get("kind") == "hardware":
            assert asked["component"] == components[step["release"]]
        if asked.get("kind") == "acknowledge":
            assert asked["service"] == f"/claim_watch/acknowledge_{step['release']}"
        elif step["phase"] == "claim" and (cell, step["release"]) in _CLAIMS:
            assert set(asked["controllers"]) == _CLAIMS[cell, step["release"]]


def test_gates_release_one_device_a_line() -> None:
    gates = unbroken(built("openarm_bimanual").texts["gates/promotion.md"])
    for phase, word in _WORDS.items():
        for name in ("left", "right"):
            command = f"ros2 launch openarm_bimanual {phase}.launch.xml confirm_{_ARGUMENT[phase]}:={word}_FOR_{name}\n"
            assert gates.count(command) == 1
    assert "- [ ] left: Authorize hardware that moves on activation." in gates
    assert "- [ ] right: Authorize the claims." in gates


_ARGUMENT = {"activate": "activation", "claim": "claim"}


def _cells_with_adapters() -> dict[str, Cell]:
    graphs = {name: built(name).graph for name in EVERY_CELL}
    valid = {path.stem: graph_of(path) for path in sorted((CORPUS / "valid").glob("*.yaml"))}
    return {name: graph.cell for name, graph in (graphs | valid).items() if graph.cell.adapters}


def test_an_adapter_reads_from_its_configuration_on_and_takes_goals_from_the_claim_on() -> None:
    cells = _cells_with_adapters()
    assert "hybrid_sdk" in cells
    for cell in cells.values():
        plan = bring_up(cell)
        nodes = {adapted.node for adapted in cell.adapters} & {node.full_name for node in cell.nodes}
        asked = [(step.phase.value, step.request) for step in plan.real if isinstance(step.request, Transition)]
        for node in nodes:
            steps = [(phase, request.transition) for phase, request in asked if request.node == node]
            assert steps == [("start", "configure"), ("claim", "activate")]
            moving = next(step for step in plan.real if step.phase.value == "move")
            assert LifecycleProof(kind="lifecycle", node=node, state="active") in moving.proof
        assert not nodes & {step.request.node for step in plan.mock if isinstance(step.request, Transition)}


def test_gates_of_an_adapter_read_it_before_it_is_claimed() -> None:
    page = built("hybrid_sdk").texts["gates/promotion.md"]
    launched = page.index("Authorize the hardware launch again")
    read = page.index("Check that the adapter reads and publishes")
    assert launched < read < page.index("--gate G4") < page.index("Authorize the claims")
    assert json.loads(built("hybrid_sdk").texts["config/observe.json"])["real"]["lifecycle"]["/arm"] == "inactive"
