"""The graphs of the complete cell answer what can be read off its page."""

from __future__ import annotations

import subprocess
import sys

import pytest

from cellc.compiler.graph.cell_graph import CellGraph
from tests.cells import COMPLETE, ROOT, diagnose, graph_of


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
    nic = graph.network.nic_of(arm)
    assert nic is not None
    assert nic.full_name == "control_pc/robot"
    assert arm.address is not None
    assert nic.interface is not None
    assert arm.address in nic.interface.network


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
