"""What nodes have at the graph: of a kind, of the program that they run, and nothing of either for a device's own."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from cellc.compiler.catalog.programs import InnerNodeFacts
from cellc.compiler.cell.interface import Node, NodeEndpoints, NodeSource
from cellc.compiler.link.programs import endpoints, implied_endpoints, inner_nodes, with_programs
from cellc.contract.vocabulary import Distro
from tests.cells import COMPLETE, linked


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
    assert [one.full_name for one in inner_nodes(facts, "", Distro("kilted"), str)][-1] == "/late"


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
