"""References of a spec mean goals, programs, ends, controllers; one wrong name is one finding."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.programs import InnerNodeFacts
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Node, NodeEndpoints, NodeSource
from cellc.compiler.link.ports import listened, port_shifts
from cellc.compiler.link.programs import endpoints, implied_endpoints, inner_nodes, with_programs
from cellc.compiler.pipeline import check
from cellc.compiler.spec.devices import DeviceSpec
from cellc.contract.diagnostics import Diagnostic
from cellc.contract.vocabulary import Distro
from tests.cells import COMPLETE, ROOT, device_of, diagnose, linked, linking, spec_text, there, written
from tests.spec.reading import ARM, HEAD

TWO_ARMS = ROOT / "tests" / "consumers" / "two_arms.yaml"
HEARD = """
interfaces:
  /left/arm_trajectory/controller_state:
    topic: control_msgs/msg/JointTrajectoryControllerState
    from: {source}
    to: left_task
"""


def _linked(folder: Path, text: str) -> tuple[Cell | None, list[str]]:
    outcome = linking(written(folder, text))
    return outcome.value, [f"{diagnostic.code}: {diagnostic.help}" for diagnostic in outcome.diagnostics]


def _heard_from(source: str) -> str:
    return TWO_ARMS.read_text(encoding="utf-8").replace("\ninterfaces:\n", HEARD.format(source=source), 1)


def test_name_of_two_controllers_is_ambiguous(tmp_path: Path) -> None:
    _, problems = _linked(tmp_path, _heard_from("arm_trajectory"))
    assert problems == ["ambiguous-node: write `/left/arm_trajectory` or `/right/arm_trajectory`"]


def test_full_name_tells_which_of_two_controllers_is_meant(tmp_path: Path) -> None:
    cell, problems = _linked(tmp_path, _heard_from("/right/arm_trajectory"))
    assert problems == []
    (topic,) = (
        interface for interface in there(cell).interfaces if interface.name == "/left/arm_trajectory/controller_state"
    )
    assert [end.full_name for end in topic.sources] == ["/right/arm_trajectory"]


def test_node_stands_at_its_interfaces_under_its_namespace(tmp_path: Path) -> None:
    text = TWO_ARMS.read_text(encoding="utf-8").replace("  left_task: {", "  left_task: {namespace: /left, ", 1)
    cell, problems = _linked(tmp_path, text)
    assert problems == []
    (action,) = (
        interface for interface in there(cell).interfaces if interface.name == "/left/gripper_action/gripper_cmd"
    )
    assert [(end.node, end.full_name) for end in action.sinks] == [("left_task", "/left/left_task")]


def test_ends_of_a_cell_have_names_of_their_own(tmp_path: Path) -> None:
    cell, _ = _linked(tmp_path, TWO_ARMS.read_text(encoding="utf-8"))
    ends = {
        (end.node, end.full_name)
        for interface in there(cell).interfaces
        for end in (*interface.sources, *interface.sinks)
    }
    assert len({node for node, _ in ends}) == len({full for _, full in ends}) == len(ends)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("mount: {parent: arm/tool0, xyz: 0 -70", "mount: {parent: arm/toolO, xyz: 0 -70"),
        ("mount: {parent: arm/tool0, xyz: 0 0 11", "mount: {parent: arm/flang, xyz: 0 0 11"),
        ("mount: {parent: world, xyz: 0 0 0.8 m}", "mount: {parent: wrld, xyz: 0 0 0.8 m}"),
        ("tcp: {parent: gripper/base", "tcp: {parent: gripper/bass"),
        ("    parent: camera/color_optical", "    parent: camera/colour_optical"),
    ],
)
def test_wrong_parent_is_told_once_and_where_it_stands(old: str, new: str, tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert text.count(old) == 1
    line = text[: text.index(old)].count("\n") + 1
    found = diagnose(written(tmp_path, text.replace(old, new)))
    assert [(finding.code, finding.span.line) for finding in found] == [("unknown-frame", line)]


@pytest.mark.parametrize(
    ("run", "refused"),
    [
        ("cell_tasks/pick_place", False),
        ("cell_tasks", True),
        ("/pick_place", True),
        ("cell_tasks/", True),
        ("1cell/pick_place", True),
        ("cell_tasks/bin/pick_place", True),
    ],
)
def test_program_of_a_node_is_a_package_and_an_executable(run: str, refused: bool, tmp_path: Path) -> None:
    spec = f"{HEAD}{ARM}nodes: {{task: {{run: {run}}}}}\n"
    found = [(diagnostic.code, diagnostic.yaml_path) for diagnostic in linking(written(tmp_path, spec)).diagnostics]
    assert (("not-an-executable", ("nodes", "task", "run")) in found) is refused, found


PUT = "put: {group: load, frame: nest"


def _refused(folder: Path, put: str) -> Diagnostic:
    (problem,) = linking(written(folder, spec_text("dual_ur").replace(PUT, put))).diagnostics
    return problem


def test_the_only_group_of_a_cell_is_that_of_its_goals(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert "group:" not in text.partition("goals:")[2].partition("\n\n")[0]
    assert {goal.group for goal in linked(written(tmp_path, text)).goals} == {"manipulator"}


def test_a_goal_of_several_groups_must_name_its_own(tmp_path: Path) -> None:
    assert PUT in spec_text("dual_ur")
    problem = _refused(tmp_path, "put: {frame: nest")
    assert (problem.code, problem.yaml_path) == ("unknown-group", ("motion", "goals", "put"))
    assert problem.message == "goal `put` must name its group: the cell has 2"
    assert problem.help == "write `group:` with one of `load`, `unload`"


def test_a_group_that_is_misspelt_is_named_with_the_nearest(tmp_path: Path) -> None:
    problem = _refused(tmp_path, "put: {group: laod, frame: nest")
    assert problem.message == "there is no group `laod`"
    assert problem.help.startswith("did you mean `load`")


_MANY = 300
_MOST = 100  # docs of `MAX_FINDINGS`

_TOPIC = {"topic": "geometry_msgs/msg/PoseStamped", "wants": "newest", "frame": "world", "rate": "10 Hz"}
_STAGE = {"model": "pedestal", "mount": {"parent": "world", "xyz": "0 0 0 m"}}
_NODE = {"run": "tasks/node", "owner": "team"}

WRONG = {
    "frames": {"frames": {f"f{n}": {"parent": f"nothing{n}", "xyz": "0 0 0 m"} for n in range(_MANY)}},
    "models": {"devices": {f"d{n}": {"model": f"nothing{n}", "mount": _STAGE["mount"]} for n in range(_MANY)}},
    "mounts": {
        "devices": {f"d{n}": {**_STAGE, "mount": {"parent": f"nothing{n}", "xyz": "0 0 0 m"}} for n in range(_MANY)}
    },
    "hosts": {"nodes": {f"n{n}": {**_NODE, "host": f"nothing{n}"} for n in range(_MANY)}},
    "ends": {
        "nodes": {"n": _NODE},
        "interfaces": {f"/t{n}": {**_TOPIC, "from": "n", "to": f"nothing{n}"} for n in range(_MANY)},
    },
    "ends of one topic": {
        "nodes": {"n": _NODE},
        "interfaces": {"/t": {**_TOPIC, "from": "n", "to": [f"nothing{n}" for n in range(_MANY)]}},
    },
    "controllers": {
        "control": {
            "update_rate": "500 Hz",
            "controllers": {f"c{n}": {"type": f"nothing{n}", "device": "d"} for n in range(_MANY)},
        },
    },
}


@pytest.mark.parametrize("sections", WRONG.values(), ids=WRONG)
def test_binding_stops_and_says_what_it_left(sections: dict[str, object], tmp_path: Path) -> None:
    spec = {"format": 1, "cell": "large", "versions": {"ros": "jazzy"}, "devices": {"d": _STAGE}, **sections}
    (tmp_path / "cell.yaml").write_text(json.dumps(spec), encoding="utf-8")
    checked = check(tmp_path / "cell.yaml")
    assert not checked.ok
    assert {finding.code.partition("-")[0] for finding in checked} == {"unknown"}
    (last,) = (finding for finding in checked if "not checked after so many findings: " in finding.help)
    left = int(last.help.rpartition("findings: ")[2].split()[0])
    assert len(checked.diagnostics) == _MOST
    assert left == _MANY - _MOST


@cache
def _nodes() -> dict[str, Node]:
    return {node.name: node for node in linked(COMPLETE).nodes}


def _bare(name: str, **changes: Any) -> Node:
    node = replace(_nodes()[name], endpoints=NodeEndpoints(), inside=())
    return replace(node, **changes)


@pytest.mark.parametrize(
    ("node", "serves"),
    [
        (_bare("controller_manager"), "/controller_manager/switch_controller"),
        (_bare("controller_manager", namespace="/left"), "/left/controller_manager/switch_controller"),
        (_bare("controller_manager", source=NodeSource.DEVICE), None),  # a device tells of its own
        (_bare("controller_manager", executable="another"), None),
        (_bare("task"), None),
    ],
    ids=["manager", "named", "of a device", "another program", "of the cell"],
)
def test_catalog_adds_what_it_knows_of_a_program(node: Node, serves: str | None) -> None:
    (found,) = with_programs([node], Distro("jazzy"))
    assert (found == node) is (serves is None)
    assert serves is None or serves in found.endpoints.serves


def test_own_endpoints_of_a_node_stay_before_those_of_its_program() -> None:
    own = NodeEndpoints(serves=("~/mine",))
    (found,) = with_programs([_bare("controller_manager", endpoints=own)], Distro("humble"))
    assert found.endpoints.serves[:2] == ("~/mine", "/controller_manager/configure_controller")
    assert "/controller_manager/cleanup_controller" not in found.endpoints.serves  # of jazzy and later


def test_inner_nodes_are_named_in_the_namespace_of_their_process_and_below_themselves() -> None:
    facts = [
        InnerNodeFacts(name="inner", publishes=("~/state", "pose", "/tf"), source="made up", parameters=False),
        InnerNodeFacts(name="/elsewhere", serves=("get",), source="made up"),
        InnerNodeFacts(name="late", only=(Distro("kilted"),), source="made up"),
    ]
    inner, elsewhere = inner_nodes(facts, "/left", Distro("jazzy"), str)
    assert (inner.full_name, inner.parameters) == ("/left/inner", False)
    assert inner.endpoints.publishes == ("~/state", "/left/pose", "/tf")
    assert (elsewhere.full_name, elsewhere.endpoints.serves) == ("/elsewhere", ("/get",))
    assert [node.full_name for node in inner_nodes(facts, "", Distro("kilted"), str)][-1] == "/late"


def test_what_is_implied_follows_kind_and_distribution() -> None:
    humble, kilted = implied_endpoints(Distro("humble")), implied_endpoints(Distro("kilted"))
    assert humble.node.publishes == ("/parameter_events", "/rosout")
    assert "~/get_type_description" in kilted.node.serves
    assert "~/get_type_description" not in humble.node.serves
    assert (humble.lifecycle.publishes, humble.controller.serves) == (("~/transition_event",), ())
    assert kilted.controller.serves == ("~/get_logger_levels", "~/set_logger_levels")
    assert (humble.component.publishes, kilted.component.publishes) == ((), ("~/hardware_status",))
    assert kilted.transforms.serves == ("tf2_frames",)
    assert endpoints(None) == NodeEndpoints()


def robot(**connection: object) -> DeviceSpec:
    """Return a robot as a spec states it."""
    return DeviceSpec.model_validate({"model": "ur5e", "connection": {"host": "pc", **connection}})


def model() -> DeviceModel:
    """Return a robot that connects back to four ports, 50001 to 50004."""
    entry = device_of("ur5e")
    return entry.model


def literal() -> DeviceModel:
    """Return the same with its ports as plain numbers, so that nothing moves them."""
    facts = model()
    assert facts.control is not None
    assert facts.control.hardware.real is not None
    plain = {
        name: value.replace("{port_", "").replace("}", "")
        for name, value in facts.control.hardware.real.parameters.items()
    }
    real = facts.control.hardware.real.model_copy(update={"parameters": plain})
    hardware = facts.control.hardware.model_copy(update={"real": real})
    return facts.model_copy(update={"control": facts.control.model_copy(update={"hardware": hardware})})


def ports(devices: dict[str, tuple[DeviceSpec, DeviceModel]]) -> dict[str, tuple[int, ...]]:
    """Return the ports of each device."""
    shifts = port_shifts(devices)
    return {name: listened(facts, shifts[name]) for name, (_, facts) in devices.items()}


def test_a_lone_robot_has_the_ports_of_its_vendor() -> None:
    assert ports({"arm": (robot(), model())}) == {"arm": (50001, 50002, 50003, 50004)}


def test_two_models_with_the_same_ports_are_moved_apart() -> None:
    other = model().model_copy(update={"model": "another"})
    assert ports({"left": (robot(), model()), "right": (robot(), other)})["right"] == (50011, 50012, 50013, 50014)


def test_the_same_ports_are_free_on_another_computer() -> None:
    assert ports({"left": (robot(), model()), "right": (robot(host="other"), model())})["right"][0] == 50001


def test_ports_that_the_spec_states_are_taken_before_others_are_given() -> None:
    found = ports({"left": (robot(), model()), "right": (robot(first_port=50003), model())})
    assert found["right"] == (50003, 50004, 50005, 50006)
    assert not set(found["left"]) & set(found["right"])


def test_ports_that_are_plain_numbers_of_an_entry_stay_and_the_others_make_room() -> None:
    found = ports({"left": (robot(), model()), "right": (robot(), literal())})
    assert found["right"] == (50001, 50002, 50003, 50004)
    assert found["left"] == (50011, 50012, 50013, 50014)
