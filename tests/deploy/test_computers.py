"""What the package states of each computer is what its spec states, and each part of the tuple is read somewhere."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cellc.compiler.deploy.computers import computers
from tests.cells import CORPUS, EVERY_CELL, built, graph_of, spec_of, spec_text, written


def _stated(spec: Path) -> dict[str, dict[str, object]]:
    found = computers(graph_of(spec))
    return {name: each.model_dump(exclude_defaults=True) for name, each in found.items()}


def test_one_computer_has_its_cards_routes_kernel_and_clock() -> None:
    (stated,) = _stated(spec_of("ur5e_pick")).values()
    assert stated["cards"] == {"robot": {"address": "192.168.56.10/24"}, "bulk": {"address": "10.10.0.10/24"}}
    assert stated["routes"] == {"arm": {"address": "192.168.56.101", "card": "robot"}}
    assert stated["environment"] == {"ROS_DOMAIN_ID": "42", "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}
    assert (stated["scheduling"], stated["controls"], stated["max_offset_s"]) == ("preempt_rt", True, 0.001)


def test_each_of_two_computers_has_its_own() -> None:
    stated = _stated(spec_of("fr3_hand"))
    assert stated["control_pc"]["routes"] == {"arm": {"address": "172.16.0.2", "card": "robot"}}
    assert "routes" not in stated["planner_pc"]
    assert stated["planner_pc"]["cards"] == {"cell": {"address": "10.20.0.11/24"}}
    assert (stated["control_pc"]["controls"], stated["planner_pc"]["controls"]) == (True, False)


def test_computer_without_nodes_is_compared_by_people() -> None:
    assert list(_stated(CORPUS / "valid/two_hosts.yaml")) == ["control_pc"]


def test_clock_that_chrony_does_not_discipline_has_no_bound_here(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert text.count("synchronized_by: chrony") == 1
    (stated,) = _stated(written(tmp_path, text.replace("synchronized_by: chrony", "synchronized_by: ptp"))).values()
    assert "max_offset_s" not in stated


def test_cell_without_hosts_has_one_computer_without_a_name() -> None:
    assert list(_stated(spec_of("minimal"))) == [""]


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_every_pinned_part_is_compared_by_a_program_or_read_by_a_person(cell: str) -> None:
    texts = built(cell).texts
    compared = {part.split("=")[0] for each in computers(graph_of(spec_of(cell))).values() for part in each.versions}
    page = texts["gates/promotion.md"].replace("\\", "")
    pinned = {name for name, text in json.loads(texts["manifest.json"])["version_tuple"].items() if text != "UNKNOWN"}
    assert {name for name in pinned - compared if name not in page} == set()
    assert compared <= pinned


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_each_computer_compares_its_versions_when_it_starts(cell: str) -> None:
    texts = built(cell).texts
    started = {Path(name).name.removesuffix(".launch.xml") for name in texts if name.startswith("launch/")}
    launched = started - {"cell", "activate", "claim", "goal", "move", "view", "among_mock"}
    steps = json.loads(texts["config/bring_up.json"])["real"]
    compared = {step["host"]: step["proof"] for step in steps if step["name"].startswith("compare_versions")}
    # It asks no node, so that it waits for none on another computer.
    assert compared == {host: [] for host in launched or {""}}
    for host in launched:
        assert f"--target real --host {host} start" in texts[f"launch/{host}.launch.xml"]
