"""What another distribution makes of a cell, held against what vendors and upstream declare for each."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import jsonschema
import pytest

from cellc.compiler.catalog.load import load_distros
from cellc.compiler.spec.schema import schema_files
from cellc.contract.upgrade import Upgrade
from cellc.contract.vocabulary import Distro
from cellc.tools.review.declared import parameter_changes
from cellc.tools.review.tuples import moved_pins
from cellc.tools.review.upgrade import Planned, plan_upgrade
from cellc.tools.review.upgrade_text import upgrade_markdown
from tests.catalog.declarations import DECLARATIONS, upstream_parameters
from tests.cells import linked, spec_of, spec_text, written
from tests.cli.run import MINIMAL, run
from tests.review.revisions import edited

CELLS = ("ur5e_pick", "fr3_hand", "gen3_2f")


@cache
def _planned(cell: str, target: Distro) -> Planned:
    return plan_upgrade(spec_of(cell).as_posix(), target)


def _upgrade(cell: str, target: Distro) -> Upgrade:
    return _planned(cell, target).upgrade


def _pins(cell: str, target: Distro) -> dict[str, str]:
    table = load_distros().value
    assert table is not None
    moves = moved_pins(linked(spec_of(cell)), target, table.distros[target])
    return {f"{move.pin.holder}.{move.pin.part}": move.text for move in moves}


@pytest.mark.parametrize(
    ("cell", "target", "expected"),
    [
        # Universal_Robots_ROS2_Driver 4.8.0 is that of kilted, 2.14.0 that of humble; rosdistro of 2026-08-22.
        (
            "ur5e_pick",
            Distro.KILTED,
            {
                "ur5e_pick.os": "ubuntu 24.04",
                "ur5e_pick.kernel": "6.8.1-1015-realtime",
                "ur5e_pick.rmw": "rmw_fastrtps_cpp 9.3.5",
                "ur5e_pick.moveit": "2.14.3",
                "arm.driver": "ur_robot_driver 4.8.0",
                "arm.sdk": "ur_client_library 2.14.1",
                "arm.firmware": "polyscope 5.21.0",
                "gripper.driver": "robotiq_driver 3b6cf8f",
            },
        ),
        # The branch humble of ros2_robotiq_gripper is a29c69b; nothing says which kernel ubuntu 22.04 runs.
        (
            "ur5e_pick",
            Distro.HUMBLE,
            {
                "ur5e_pick.os": "ubuntu 22.04",
                "ur5e_pick.kernel": "UNKNOWN",
                "ur5e_pick.moveit": "2.5.9",
                "arm.driver": "ur_robot_driver 2.14.0",
                "gripper.driver": "robotiq_driver a29c69b7516b7a97737b5e43e118e6598ace0832",
            },
        ),
        # franka_ros2 v3.4.0, dependency.repos: libfranka 0.20.5, franka_description 2.8.0. There is none for kilted.
        (
            "fr3_hand",
            Distro.JAZZY,
            {
                "arm.driver": "franka_ros2 3.4.0",
                "arm.sdk": "libfranka 0.20.5",
                "arm.description": "franka_description 2.8.0",
                "arm.firmware": "system_image 5.9.0",
            },
        ),
        ("fr3_hand", Distro.KILTED, {f"arm.{part}": "UNKNOWN" for part in ("driver", "sdk", "description")}),
        # ros2_kortex humble 116d87a fetches Kortex API 2.7.0, jazzy 2.5.0; its number 0.2.3 pins nothing.
        (
            "gen3_2f",
            Distro.HUMBLE,
            {"arm.driver": "ros2_kortex 116d87ae595c791ba7ae32201b88693a3ba02324", "arm.sdk": "kortex_api 2.7.0"},
        ),
    ],
)
def test_pins_become_what_belongs_to_the_distribution(cell: str, target: Distro, expected: dict[str, str]) -> None:
    pins = _pins(cell, target)
    assert {name: pins[name] for name in expected} == expected


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("target", Distro)
def test_parameters_that_appear_vanish_and_change_are_those_of_upstream(cell: str, target: Distro) -> None:
    of = linked(spec_of(cell))
    found = parameter_changes(of, target, {}, {})
    for controller in of.controllers:
        kind = None if controller.declared is None else controller.declared.kind
        if kind not in DECLARATIONS:
            continue
        was, now = (upstream_parameters(str(kind), distro) for distro in (of.distro, target))
        own = [
            finding
            for finding in found
            if controller.full_name in finding.nodes and finding.parameter != "thread_priority"
        ]
        assert {one.parameter for one in own if one.change == "appears"} == now.keys() - was.keys()
        assert {one.parameter for one in own if one.change == "vanishes"} == was.keys() - now.keys()
        assert {one.parameter for one in own if one.what == "default"} == {
            name for name in was.keys() & now.keys() if was[name].get("default_value") != now[name].get("default_value")
        }


def test_a_default_that_changes_unseen_is_asked_about_and_one_that_the_cell_states_is_not() -> None:
    # ros2_control 4.46 shuts down where an initial state fails, 5.16 goes on; cellc writes enforce_command_limits.
    upgrade = _upgrade("ur5e_pick", Distro.KILTED)
    assert [question.split(":")[0] for question in upgrade.questions] == [
        "`hardware_components_initial_state.shutdown_on_initial_state_failure` of /controller_manager",
        "`rollback`",
    ]
    (limits,) = (parameter for parameter in upgrade.parameters if parameter.parameter == "enforce_command_limits")
    assert (limits.before, limits.after, limits.stated, limits.question) == ("false", "true", True, "")


def test_names_at_the_graph_are_those_that_nodes_of_the_distribution_have() -> None:
    # A component of ros2_control 5.16 publishes ~/hardware_status; before jazzy a component had no node.
    (gained,) = _upgrade("ur5e_pick", Distro.KILTED).interfaces
    assert (gained.change, gained.right, gained.name) == ("gained", "publish", "~/hardware_status")
    assert gained.nodes == ("/arm_hardware", "/gripper_hardware")
    lost = {
        node
        for interface in _upgrade("ur5e_pick", Distro.HUMBLE).interfaces
        if interface.change == "lost"
        for node in interface.nodes
    }
    assert lost >= {"/arm_hardware", "/gripper_hardware"}


def test_a_cell_that_the_distribution_cannot_have_says_why_and_compares_nothing() -> None:
    upgrade = _upgrade("fr3_hand", Distro.KILTED)
    assert upgrade.review is None
    assert [found.code for found in upgrade.errors] == ["controller-not-in-distro"]
    # Versions are looked at by G0 and L2, and everything after them rests on that.
    assert [gate.code for gate in upgrade.gates] == [*(f"G{n}" for n in range(8)), *(f"L{n}" for n in range(2, 7))]


def test_the_new_pins_are_written_and_nothing_else_and_lead_back(tmp_path: Path) -> None:
    spec = written(tmp_path, spec_text("ur5e_pick"))
    ran = run("upgrade", spec.as_posix(), "--ros", "kilted", "--write")
    assert ran.code == 1
    assert f"{spec.as_posix()}:9: `ros` of `ur5e_pick`: `jazzy` becomes `kilted`" in ran.err
    old, new = spec_text("ur5e_pick").split("\n"), spec.read_text(encoding="utf-8").split("\n")
    assert [line.strip() for line, before in zip(new, old, strict=True) if line != before] == [
        "ros: kilted",
        "rmw: rmw_fastrtps_cpp 9.3.5",
        "ros2_control: 5.17.0",
        "moveit: 2.14.3",
        "driver: ur_robot_driver 4.8.0",
        "description: ur_description 4.3.1",
    ]
    assert run("upgrade", spec.as_posix(), "--ros", "jazzy", "--write").code == 1
    assert spec.read_text(encoding="utf-8") == spec_text("ur5e_pick")


def test_quotes_anchors_and_included_files_are_kept(tmp_path: Path) -> None:
    text = edited(
        ("  driver: ur_robot_driver 3.8.0\n", "  driver: &pinned 'ur_robot_driver 3.8.0'\n"),
        ("  ros2_control: 4.47.0\n", '  ros2_control: "4.47.0"  # as tested\n'),
        ("  moveit: 2.12.4\n", "  moveit: 2.12.4\n"),
        ("cell: ur5e_pick\n", "cell: ur5e_pick\ninclude: tuple.yaml\n"),
    )
    start, end = text.index("versions:"), text.index("hosts:")
    (tmp_path / "tuple.yaml").write_text(text[start:end], encoding="utf-8")
    spec = written(tmp_path, text[:start] + text[end:])
    assert run("upgrade", spec.as_posix(), "--ros", "kilted", "--write").code == 1
    assert "  driver: &pinned 'ur_robot_driver 4.8.0'\n" in spec.read_text(encoding="utf-8")
    assert '  ros2_control: "5.17.0"  # as tested\n' in (tmp_path / "tuple.yaml").read_text(encoding="utf-8")


def _moved_to_kilted(tmp_path: Path, *edits: tuple[str, str]) -> list[str]:
    """Return the lines of the cell with two arms that an upgrade writes, trimmed."""
    spec = written(tmp_path, edited(*edits, cell="dual_ur"))
    before = spec.read_text(encoding="utf-8").split("\n")
    assert run("upgrade", spec.as_posix(), "--ros", "kilted", "--write").code == 1
    after = spec.read_text(encoding="utf-8").split("\n")
    return [new.strip() for new, old in zip(after, before, strict=True) if new != old]


_ANCHORS = [
    "firmware: polyscope 5.21.0, driver: &driver ur_robot_driver 4.8.0, sdk: &sdk ur_client_library 2.14.1,",
    "description: &description ur_description 4.3.1,",
]
"""Versions of kilted, as in the first test."""


def test_an_alias_stays_where_its_anchor_becomes_the_same(tmp_path: Path) -> None:
    assert _moved_to_kilted(tmp_path)[4:] == _ANCHORS
    assert "driver: *driver, sdk: *sdk, description: *description," in (tmp_path / "cell.yaml").read_text()


def test_an_alias_of_what_is_no_pin_is_written_out(tmp_path: Path) -> None:
    summary = ("summary: A UR10e loads blanks", "summary: &driver ur_robot_driver 3.8.0 #")
    own = ("driver: &driver ur_robot_driver", "driver: ur_robot_driver")
    moved = _moved_to_kilted(tmp_path, summary, own)
    assert moved[4:6] == [_ANCHORS[0].replace("&driver ", ""), _ANCHORS[1]]
    assert moved[6:] == [
        "firmware: polyscope 5.21.0, driver: ur_robot_driver 4.8.0, sdk: *sdk, description: *description,"
    ]


def test_json_is_what_its_schema_says_and_markdown_is_a_comment() -> None:
    ran = run("upgrade", MINIMAL, "--ros", "jazzy", "--format", "json")
    schema = json.loads(schema_files()["upgrade.schema.json"])
    jsonschema.validate(json.loads(ran.out), schema)
    assert (ran.code, json.loads(ran.out)["questions"]) == (0, [])
    upgrade = _upgrade("ur5e_pick", Distro.KILTED)
    jsonschema.validate(json.loads(upgrade.model_dump_json()), schema)
    text = upgrade_markdown(upgrade)
    assert text.startswith("### `ur5e_pick`: jazzy to kilted: 6 pins change, 2 questions\n")
    assert text.count("<details") == text.count("</details>")
    assert len(text) <= 65_000


def test_a_spec_with_errors_is_not_upgraded(tmp_path: Path) -> None:
    spec = written(tmp_path, edited(("update_rate: 500 Hz", "update_rate: 250 Hz")))
    ran = run("upgrade", spec.as_posix(), "--ros", "kilted", "--write")
    assert (ran.code, ran.out) == (2, "")
    assert "must be 500 Hz, got 250 Hz; see `cellc check`" in ran.err
    line = spec.read_text(encoding="utf-8").split("update_rate:")[0].count("\n") + 1
    assert ran.err.startswith(f"error: {spec.as_posix()}:{line}:")


def test_a_spec_that_is_not_there_and_an_error_of_an_included_file_are_named_with_their_place(tmp_path: Path) -> None:
    ran = run("upgrade", "nofile", "--ros", "kilted")
    assert (ran.code, ran.err) == (2, "error: nofile:1:1: there is no file `nofile`; see `cellc check`\n")
    text = spec_text("ur5e_pick")
    start, end = text.index("versions:"), text.index("hosts:")
    (tmp_path / "tuple.yaml").write_text("versions:\n  ros: jazy\n", encoding="utf-8")
    spec = written(tmp_path, text[:start] + "include: tuple.yaml\n" + text[end:])
    ran = run("upgrade", spec.as_posix(), "--ros", "kilted")
    assert (ran.code, ran.err.partition("tuple.yaml")[2][:5]) == (2, ":2:8:")
