"""The graph of nodes: each box once and apart, and every interface that the contract has is in its list."""

from __future__ import annotations

import json
import re
from itertools import combinations
from typing import Any
from xml.etree.ElementTree import Element, fromstring

import pytest

from tests.cells import EVERY_CELL, ROOT

_SVG = "{http://www.w3.org/2000/svg}"
Rect = tuple[float, float, float, float]


def _contract(cell: str) -> Any:
    return json.loads((ROOT / f"generated/{cell}/contract.json").read_text(encoding="utf-8"))


def _picture(cell: str) -> Element:
    return fromstring((ROOT / f"generated/{cell}/graph/nodes.svg").read_text(encoding="utf-8"))


def _boxes(picture: Element) -> list[tuple[str, Rect]]:
    """Return the name in each box, with left, top, right, bottom."""
    (group,) = picture.findall(f"{_SVG}g")
    found = []
    for rect in group.findall(f"{_SVG}rect"):
        x, y, wide, high = (float(rect.attrib[key]) for key in ("x", "y", "width", "height"))
        lines = [
            text.text or ""
            for text in group.findall(f"{_SVG}text")
            if x < float(text.attrib["x"]) < x + wide and y < float(text.attrib["y"]) < y + high
        ]
        found.append(("".join(lines), (x, y, x + wide, y + high)))
    return found


def _ends(contract: Any) -> set[str]:
    used = [one for one in contract["interfaces"].values() if one["sources"] and one.get("sinks")]
    return {end["node"] for one in used for end in (*one["sources"], *one["sinks"])}


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_every_end_and_every_device_is_one_box(cell: str) -> None:
    contract = _contract(cell)
    names = [name for name, _ in _boxes(_picture(cell))]
    assert len(names) == len(set(names))
    assert _ends(contract) | set(contract["devices"]) | {contract["safety"]["stop_authority"]} <= set(names)


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_boxes_stand_apart_within_the_sheet(cell: str) -> None:
    picture = _picture(cell)
    width, height = (float(value) for value in picture.attrib["viewBox"].split()[2:])
    places = [place for _, place in _boxes(picture)]
    assert all(left >= 0 and right <= width and top >= 0 and bottom <= height for left, top, right, bottom in places)
    assert not [
        (a, b) for a, b in combinations(places, 2) if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
    ]


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_the_list_has_every_interface_with_two_ends_and_every_number_is_at_an_arrow(cell: str) -> None:
    contract, picture = _contract(cell), _picture(cell)
    listed = " ".join(text.text or "" for text in picture.findall(f"{_SVG}text"))
    used = {name for name, one in contract["interfaces"].items() if one["sources"] and one.get("sinks")}
    assert used <= set(re.split(r"[ ,]+", listed))
    numbers = {text.text for text in picture.findall(f"{_SVG}text") if (text.text or "").isdigit()}
    at_arrows = {text.text for text in picture.iter(f"{_SVG}text") if text.get("font-size") == "10"}
    assert numbers == at_arrows != set()


def test_what_commands_goes_from_left_to_right() -> None:
    # cells/ur5e_pick: the task asks move_group, which asks arm_trajectory, which claims the arm; a PLC stops it.
    left = {name: place[0] for name, place in _boxes(_picture("ur5e_pick"))}
    way = [left[name] for name in ("task", "move_group", "arm_trajectory", "arm", "safety_plc")]
    assert way == sorted(set(way))
    assert left["perception"] < left["task"]
