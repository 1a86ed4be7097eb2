"""The nodes of a real target against what the vendor's programs wait for, offer and hear."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any
from xml.etree import ElementTree

import pytest

from tests.consumers.permissions import policy_of
from tests.oracles import here
from tests.vendors.oracle import facts
from tests.vendors.packages import CASES, Case, RealTarget, real_target

_PROGRAMS = ("dashboard_client", "robot_state_helper")
"""Programs of the driver that a cell of the repository starts; each is a node of the vendor's launch file."""

with_nodes = [case for case in CASES if case.release.device == "ur5e"]
every_case = pytest.mark.parametrize("case", here(with_nodes), ids=str)


def _told(case: Case) -> dict[str, Any]:
    """Return what the facts say of the programs of the driver, by executable."""
    nodes = facts(case.release, "nodes")["nodes"].values()
    return {node["executable"]: node for node in nodes if node.get("executable") in _PROGRAMS}


def _started(target: RealTarget) -> Iterator[ElementTree.Element]:
    files = [text for path, text in target.texts.items() if path.startswith("launch/") and path.endswith(".launch.xml")]
    for text in files:
        yield from (node for node in ElementTree.fromstring(text).iter("node") if node.get("exec") in _PROGRAMS)


def _in_cell(node: ElementTree.Element, name: str) -> str:
    """Return the name in the cell of one that a program says: relative ones lie in its namespace, which is the root."""
    renamed = {remap.get("from", ""): remap.get("to", "") for remap in node.findall("remap")}
    full = f"/{node.get('name')}{name[1:]}" if name.startswith("~") else f"/{name}"
    return renamed.get(full, full)


def _served(case: Case, target: RealTarget) -> set[str]:
    """Return services and topics that the programs and controllers of the cell have, as the facts list them."""
    there = {
        _in_cell(node, name)
        for node in _started(target)
        for name in _told(case)[node.get("exec", "")].get("services", {})
    }
    listed = facts(case.release, "controllers")["controllers"].values()
    for controller in target.cell.controllers:
        for told in (entry for entry in listed if entry["type"] == controller.plugin):
            ends = told["endpoints"] if isinstance(told["endpoints"], list) else []
            there |= {end["name"].replace("~", controller.full_name) for end in ends}
    return there


@every_case
def test_nobody_waits_for_what_no_node_of_the_cell_has(case: Case) -> None:
    target = real_target(case)
    there = _served(case, target)
    for node in _started(target):
        told = _told(case)[node.get("exec", "")]
        for name in (*told.get("clients", {}), *told.get("subscriptions", {})):
            assert _in_cell(node, name) in there, (node.get("name"), name)


@every_case
def test_a_node_is_given_only_parameters_that_its_program_reads(case: Case) -> None:
    target = real_target(case)
    for node in _started(target):
        given = target.yaml("config/drivers.yaml")[node.get("name")]["ros__parameters"]
        assert set(given) <= set(_told(case)[node.get("exec", "")]["parameters"])


@every_case
def test_the_policy_grants_a_node_everything_that_its_program_has(case: Case) -> None:
    target = real_target(case)
    policy = policy_of(target.texts)
    for node in _started(target):
        told = _told(case)[node.get("exec", "")]
        (profile,) = (profile for profile in policy.iter("profile") if profile.get("node") == node.get("name"))
        for names, tag, right in (
            (told.get("services", {}), "services", "reply"),
            (told.get("clients", {}), "services", "request"),
            (told.get("subscriptions", {}), "topics", "subscribe"),
            (told.get("action_servers", {}), "actions", "execute"),
        ):
            granted = {
                (one.text or "").replace("~", f"/{node.get('name')}", 1)
                for rights in profile.findall(tag)
                if rights.get(right) == "ALLOW"
                for one in rights
            }
            assert {_in_cell(node, name) for name in names} <= granted, (node.get("name"), right)


def test_the_state_helper_stays_away_where_nothing_answers_it() -> None:
    for case in with_nodes:
        if case.cell == "minimal":
            alone = replace(case, without="arm_io")  # the controller of inputs and outputs
            assert [node.get("exec") for node in _started(real_target(alone))] == ["dashboard_client"]
