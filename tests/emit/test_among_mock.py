"""Nodes of the spec beside a cell that is played: on its domain and this host, and only those that are asked for."""

from __future__ import annotations

from xml.etree.ElementTree import fromstring

import pytest

from tests.cells import EVERY_CELL, built

_FILE = "launch/among_mock.launch.xml"


@pytest.mark.parametrize("cell", [cell for cell in EVERY_CELL if _FILE in built(cell).texts])
def test_what_is_started_reaches_no_robot(cell: str) -> None:
    launch = fromstring(built(cell).texts[_FILE])
    environment = {each.get("name"): each.get("value") for each in launch.iterfind("set_env")}
    assert environment == {
        "ROS_DOMAIN_ID": "$(env CELLC_MOCK_DOMAIN 100)",
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "ROS_LOCALHOST_ONLY": "1",
    }
    tags = [each.tag for each in launch]
    assert max(at for at, tag in enumerate(tags) if tag == "set_env") < tags.index("node")
    assert set(tags) == {"arg", "set_env", "set_parameter", "node"}


@pytest.mark.parametrize("cell", [cell for cell in EVERY_CELL if _FILE in built(cell).texts])
def test_nothing_is_started_that_is_not_asked_for(cell: str) -> None:
    launch = fromstring(built(cell).texts[_FILE])
    defaults = {each.get("name"): each.get("default") for each in launch.iterfind("arg")}
    for node in launch.iterfind("node"):
        condition = str(node.get("if"))
        assert defaults[condition.removeprefix("$(var ").removesuffix(")")] == "false"


def test_the_nodes_are_those_that_a_user_writes() -> None:
    launch = fromstring(built("ur5e_pick").texts[_FILE])
    assert [(node.get("pkg"), node.get("exec")) for node in launch.iterfind("node")] == [
        ("cell_perception", "detector"),
        ("cell_tasks", "pick_place"),
    ]
    assert _FILE not in built("minimal").texts
