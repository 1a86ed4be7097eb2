"""Pictures of a build: the graph has each box once and apart and lists every interface, and all is what SVG allows."""

from __future__ import annotations

import json
import re
from itertools import combinations
from typing import Any
from xml.etree.ElementTree import Element, fromstring

import pytest

from tests.cells import EVERY_CELL, ROOT
from tests.consumers.matrix import build, every_build
from tests.consumers.test_pictures import contract

_SVG = "{http://www.w3.org/2000/svg}"
Rect = tuple[float, float, float, float]

_NUMBER = r"-?\d+(\.\d+)?"
_PLAIN = re.compile(rf"{_NUMBER}|100%|none|auto|#[0-9a-f]{{6}}|( ?{_NUMBER}[ ,]?)+|translate\({_NUMBER} {_NUMBER}\)")
_PATH = re.compile(rf"( ?[MLHCh]( ?{_NUMBER})+| Z)+")
_WORDS = {
    "font-family": {"sans-serif"},
    "font-weight": {"bold"},
    "text-anchor": {"start", "middle", "end"},
    "stroke-linecap": {"round"},
    "paint-order": {"stroke"},
    "markerUnits": {"userSpaceOnUse"},
    "orient": {"auto"},
}
_FIGURES = {
    *("x", "y", "x1", "y1", "x2", "y2", "width", "height", "rx", "points", "transform", "viewBox", "font-size"),
    *("fill", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray"),
    *("refX", "refY", "markerWidth", "markerHeight"),
}


def _picture(cell: str, distro: str) -> Element:
    return fromstring(build(cell, distro).texts["graph/nodes.svg"])


def _allowed(name: str, value: str, marks: set[str]) -> bool:
    if name in ("id", "marker-end"):
        return value.removeprefix("url(#").removesuffix(")") in marks
    if name == "d":
        return _PATH.fullmatch(value) is not None
    if name in _WORDS:
        return value in _WORDS[name]
    return name in _FIGURES and _PLAIN.fullmatch(value) is not None


@every_build
def test_pictures_have_the_attributes_and_words_of_svg(cell: str, distro: str) -> None:
    for file in ("cell", "nodes", "responsibility"):
        root = fromstring(build(cell, distro).texts[f"graph/{file}.svg"])
        marks = {element.attrib["id"] for kind in ("marker", "view") for element in root.iter(f"{_SVG}{kind}")}
        found = [(name, value) for element in root.iter() for name, value in element.attrib.items()]
        assert [(name, value) for name, value in found if not _allowed(name, value, marks)] == []
        assert all(0.0 <= float(value) <= 1.0 for name, value in found if name.endswith("opacity"))
        assert {element.tag.removeprefix(_SVG) for element in root.iter()} <= _DRAWN
        assert cell in (root.findtext(f"{_SVG}title") or "")


_DRAWN = {"svg", "title", "defs", "marker", "view", "g", "path", "rect", "polygon", "line", "text"}


def _places(group: Element, at: tuple[float, float] = (0.0, 0.0)) -> set[tuple[float, float]]:
    """Return where a group and those in it stand in the sheet."""
    x, y = (float(value) for value in re.findall(_PLACE, group.get("transform", "translate(0 0)")))
    here = at[0] + x, at[1] + y
    return {here}.union(*(_places(inner, here) for inner in group.findall(f"{_SVG}g")))


_PLACE = r"-?[\d.]+"


@every_build
def test_bodies_stand_where_a_frame_is_marked(cell: str, distro: str) -> None:
    views = fromstring(build(cell, distro).texts["graph/cell.svg"]).findall(f"{_SVG}g")
    assert len(views) == 2
    for bodies, marks in (view.findall(f"{_SVG}g") for view in views):
        assert _places(bodies) <= _places(marks)


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
    used = [
        interface for interface in contract["interfaces"].values() if interface["sources"] and interface.get("sinks")
    ]
    return {end["node"] for one in used for end in (*one["sources"], *one["sinks"])}


@every_build
def test_every_end_and_every_device_is_one_box(cell: str, distro: str) -> None:
    promised = contract(cell, distro)
    names = [name for name, _ in _boxes(_picture(cell, distro))]
    assert len(names) == len(set(names))
    assert _ends(promised) | set(promised["devices"]) | {promised["safety"]["stop_authority"]} <= set(names)


@every_build
def test_boxes_stand_apart_within_the_sheet(cell: str, distro: str) -> None:
    picture = _picture(cell, distro)
    width, height = (float(value) for value in picture.attrib["viewBox"].split()[2:])
    places = [place for _, place in _boxes(picture)]
    assert all(left >= 0 and right <= width and top >= 0 and bottom <= height for left, top, right, bottom in places)
    assert not [
        (a, b) for a, b in combinations(places, 2) if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
    ]


@every_build
def test_the_list_has_every_interface_with_two_ends_and_every_number_is_at_an_arrow(cell: str, distro: str) -> None:
    promised, picture = contract(cell, distro), _picture(cell, distro)
    listed = " ".join(text.text or "" for text in picture.findall(f"{_SVG}text"))
    used = {name for name, one in promised["interfaces"].items() if one["sources"] and one.get("sinks")}
    assert used <= set(re.split(r"[ ,]+", listed))
    numbers = {text.text for text in picture.findall(f"{_SVG}text") if (text.text or "").isdigit()}
    at_arrows = {text.text for text in picture.iter(f"{_SVG}text") if text.get("font-size") == "10"}
    assert numbers == at_arrows != set()


def test_what_commands_goes_from_left_to_right() -> None:
    # cells/ur5e_pick: the task asks move_group, which asks arm_trajectory, which claims the arm; a PLC stops it.
    left = {name: place[0] for name, place in _boxes(_picture("ur5e_pick", "jazzy"))}
    way = [left[name] for name in ("task", "move_group", "arm_trajectory", "arm", "safety_plc")]
    assert way == sorted(set(way))
    assert left["perception"] < left["task"]


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_the_stop_reaches_every_drive_whatever_commands_it(cell: str) -> None:
    # hybrid_sdk has an arm that an adapter drives, without hardware of ros2_control.
    folder = ROOT / "generated" / cell
    promised = json.loads((folder / "contract.json").read_text(encoding="utf-8"))
    adapted = promised.get("adapters", {})
    driven = [
        name
        for name, one in promised["devices"].items()
        if one.get("hardware_component") or one.get("driver") or name in adapted
    ]
    (arrows,) = fromstring((folder / "graph/nodes.svg").read_text(encoding="utf-8")).findall(f"{_SVG}g")
    assert len([element for element in arrows.iter() if element.get("marker-end") == "url(#stop)"]) == len(driven) > 0
