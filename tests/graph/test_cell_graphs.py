"""What graphs answer of cells: reachability, ages, claims, by hand."""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager, ControllerSwitch
from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.claims import ClaimGraph, WrittenParameter, can_switch, explore
from cellc.compiler.graph.data_flow import age_chains
from cellc.contract.diagnostics import Span
from cellc.contract.vocabulary import Behavior
from tests.cells import COMPLETE, ROOT, diagnose, graph_of, linked, there


@pytest.fixture(scope="module")
def graph() -> CellGraph:
    return graph_of(COMPLETE)


def test_world_is_the_one_root(graph: CellGraph) -> None:
    assert graph.frames.roots() == ("world",)
    assert graph.frames.cycles() == ()


def test_chain_of_the_tcp_ends_at_the_world(graph: CellGraph) -> None:
    names = [frame.name for frame in graph.frames.chain("tcp")]
    assert names[:4] == ["tcp", "gripper_base", "arm_tool0", "arm_flange"]
    assert names[-1] == "world"


def test_image_feeds_motion_through_perception_and_task(graph: CellGraph) -> None:
    feeding = graph.data.feeding_motion()
    assert {"/camera/camera/color/image_raw", "/object_pose"} <= feeding
    assert graph.data.path_to_motion("task") == ("task", "gripper_action")
    assert graph.data.path_to_motion("perception") in (
        ("perception", "task", "gripper_action"),
        ("perception", "move_group", "arm_trajectory"),
    )
    assert graph.data.path_to_motion("nobody") == ()


def test_start_order_puts_servers_before_clients(graph: CellGraph) -> None:
    order = graph.startup.order()
    expected = ["/controller_manager", "arm_trajectory", "move_group", "task"]
    assert [part for part in order if part in expected] == expected
    assert graph.startup.cycle() == ()


def test_card_of_the_arm_is_found(graph: CellGraph) -> None:
    arm = next(device for device in graph.network.devices if device.device == "arm")
    nic = there(graph.network.nic_of(arm))
    assert nic.full_name == "control_pc/robot"
    assert there(arm.address) in there(nic.interface).network


def test_every_responsibility_has_its_owner(graph: CellGraph) -> None:
    assert not any(item.open for item in graph.responsibilities.items)
    assert "safety" in graph.responsibilities.owners()
    assert {item.name for item in graph.responsibilities.of_owner("controls")} == {"limits", "watchdogs", "controller"}


def test_a_clean_cell_is_checked_again_without_heavy_imports() -> None:
    assert diagnose(COMPLETE) == ()  # what shapes and joints allow is kept from here on
    script = (
        "import sys; from cellc.tools.cli.batch import Task, results\n"
        f"(checked,) = results('check', [Task({str(COMPLETE)!r})])\n"
        "heavy = ('networkx', 'pinocchio', 'yourdfpy', 'numpy', 'concurrent.futures')\n"
        "print(checked.findings.diagnostics, [name for name in heavy if name in sys.modules])\n"
    )
    run = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.stdout.strip() == "() []", run.stderr


@pytest.fixture(scope="module")
def cell() -> Cell:
    return linked(COMPLETE)


def topic(cell: Cell, name: str, source: str, sink: str, rate_hz: float) -> Interface:
    pose = next(interface for interface in cell.interfaces if interface.name == "/object_pose")

    def end(node: str) -> Endpoint:
        return replace(pose.sources[0], node=node)

    return replace(pose, name=name, sources=(end(source),), sinks=(end(sink),), rate_hz=rate_hz)


def chain(cell: Cell, name: str) -> list[tuple[str, object]]:
    return [(share.topic, share.total_s) for share in age_chains(cell)[name]]


def test_pose_is_as_old_as_its_image_and_its_own_period(cell: Cell) -> None:
    # 8 ms of exposure and a period of 33.3 ms for the image, 100 ms for the pose.
    image, pose = chain(cell, "/object_pose")
    assert image == ("/camera/camera/color/image_raw", pytest.approx(0.008 + 1 / 30))
    assert pose == ("/object_pose", pytest.approx(0.1))


def test_exposure_of_the_catalog_counts_where_the_spec_states_none(tmp_path: Path) -> None:
    # The 80 ms of the catalog and a period of 33.3 ms are more than the 100 ms that the image may be old.
    shutil.copytree(COMPLETE.parent, tmp_path, dirs_exist_ok=True)
    spec, device = (tmp_path / "parts" / name for name in ("devices_camera.yaml", "demo_camera/device.yaml"))
    stated, camera = (file.read_text(encoding="utf-8") for file in (spec, device))
    spec.write_text(stated.replace(" exposure: 8 ms,", ""), encoding="utf-8")
    device.write_text(camera.replace("\ncamera:\n", "\ncamera:\n  exposure: 80 ms\n"), encoding="utf-8")
    found = {finding.code: finding.message for finding in diagnose(tmp_path / COMPLETE.name)}
    assert "must be at least 113.3 ms" in found["max-age-too-short"]


def test_freshest_of_several_inputs_counts(cell: Cell) -> None:
    slow, fast = topic(cell, "/slow", "a", "c", 1.0), topic(cell, "/fast", "b", "c", 50.0)
    made = replace(cell, interfaces=(slow, fast, topic(cell, "/out", "c", "task", 10.0)))
    assert chain(made, "/out") == [("/fast", pytest.approx(0.02)), ("/out", pytest.approx(0.1))]


def test_equally_fresh_inputs_give_the_first_by_name(cell: Cell) -> None:
    same = [topic(cell, name, name[1:], "c", 10.0) for name in ("/b", "/a")]
    made = replace(cell, interfaces=(*same, topic(cell, "/out", "c", "task", 10.0)))
    assert [name for name, _ in chain(made, "/out")] == ["/a", "/out"]


def test_topics_in_a_circle_observe_nothing(cell: Cell) -> None:
    circle = (topic(cell, "/there", "a", "b", 10.0), topic(cell, "/back", "b", "a", 10.0))
    made = replace(cell, interfaces=circle)
    assert chain(made, "/there") == [("/there", pytest.approx(0.1))]
    assert chain(made, "/back") == [("/back", pytest.approx(0.1))]


SPAN = Span("cell.yaml", 1, 1, 1, 2)


def controller(name: str, *claims: str, active: bool = False) -> Controller:
    return Controller(
        name=name,
        path=("control", "controllers", name),
        span=SPAN,
        manager="control",
        label=name,
        kind="forward_command",
        behavior=Behavior.FORWARD_COMMAND,
        plugin="any/Plugin",
        command_interfaces=claims,
        active=active,
    )


def switch(name: str, activate: tuple[str, ...] = (), deactivate: tuple[str, ...] = ()) -> ControllerSwitch:
    return ControllerSwitch(name=name, path=("switches", name), span=SPAN, activate=activate, deactivate=deactivate)


def graph_claims(controllers: tuple[Controller, ...], switches: tuple[ControllerSwitch, ...] = ()) -> ClaimGraph:
    manager = ControllerManager(
        name="control", path=("control",), span=SPAN, update_rate_hz=500.0, controllers=controllers, switches=switches
    )
    return ClaimGraph(tuple(explore(manager)))


def test_start_state_holds_the_controllers_that_are_active() -> None:
    claims = graph_claims((controller("a", "j/position", active=True), controller("b", "j/position")))
    (start,) = claims.at_start()
    assert [c.name for c in start.active] == ["a"]
    assert list(claims.conflicts()) == []


def test_conflict_is_found_two_switches_away_with_the_way_there() -> None:
    controllers = (
        controller("a", "j/position", active=True),
        controller("b", "k/position"),
        controller("c", "j/position"),
    )
    switches = (switch("first", ("b",)), switch("second", ("c",), ("b",)))
    (conflict,) = graph_claims(controllers, switches).conflicts()
    assert conflict.state.switches == ("first", "second")
    assert (conflict.interface, conflict.first.name, conflict.second.name) == ("j/position", "a", "c")


def test_nothing_is_reached_through_a_refused_switch() -> None:
    controllers = (
        controller("a", "j/position", active=True),
        controller("b", "j/position"),
        controller("c", "k/position"),
    )
    switches = (switch("clash", ("b",)), switch("then", ("c",), ("b",)))
    assert "c" not in graph_claims(controllers, switches).ever_active("control")


def test_exchange_of_claims_in_one_switch_is_no_conflict() -> None:
    controllers = (controller("a", "j/position", active=True), controller("b", "j/position"))
    switches = (switch("to_b", ("b",), ("a",)), switch("to_a", ("a",), ("b",)))
    claims = graph_claims(controllers, switches)
    assert list(claims.conflicts()) == []
    assert claims.ever_active("control") == {"a", "b"}
    assert len(claims.states) == 2


def test_strict_switch_is_refused_as_the_controller_manager_does() -> None:
    # controller_manager, STRICT: deactivate what is not active, or activate what is, aborts; both lists restart.
    assert not can_switch(frozenset({"a"}), switch("x", (), ("b",)))
    assert not can_switch(frozenset({"a"}), switch("x", ("a",)))
    assert can_switch(frozenset({"a"}), switch("x", ("a",), ("a",)))


def test_items_of_a_parameter_are_those_of_its_list_or_itself() -> None:
    of_list = WrittenParameter(controller("a"), "joints", ("left", "right"), ("parameters", "joints"))
    assert list(of_list.items()) == [(("parameters", "joints", 0), "left"), (("parameters", "joints", 1), "right")]
    of_text = WrittenParameter(controller("a"), "joint", "left", ("parameters", "joint"))
    assert list(of_text.items()) == [(("parameters", "joint"), "left")]
