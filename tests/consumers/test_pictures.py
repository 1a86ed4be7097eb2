"""The responsibility graph on its sheet: complete, readable, and the same as the contract."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Any
from xml.etree.ElementTree import Element, fromstring

import pytest

from tests.consumers.matrix import build, every_build
from tests.emit.cells import contract_data

SHEET = "responsibility.svg"
_SPACE = "{http://www.w3.org/2000/svg}"
_COLUMNS = 4  # titles of bands, both boxes, what is carried
_DRAWN = {"svg", "title", "defs", "marker", "path", "rect", "text", "line"}
_ON_SEVERAL_PAGES = {"view"}


def contract(cell: str, distro: str) -> Any:
    """Return the contract as plain data."""
    return contract_data(build(cell, distro).texts["contract.json"])


def sheet(cell: str, distro: str) -> Element:
    """Return a picture."""
    return fromstring(build(cell, distro).texts[f"graph/{SHEET}"])


def facts(cell: str, distro: str) -> dict[str, list[str]]:
    """Return the lines below the name of each interface."""
    found: dict[str, list[str]] = {}
    title = ""
    for text in sheet(cell, distro).iter(f"{_SPACE}text"):
        if text.get("font-weight") == "bold":
            title = text.text or ""
        elif text.get("fill"):
            found.setdefault(title, []).append(text.text or "")
    return found


def place(one: Element, *names: str) -> tuple[float, ...]:
    """Return attributes as numbers."""
    return tuple(float(one.attrib[name]) for name in names)


def unused(promised: dict[str, Any]) -> dict[tuple[object, ...], list[str]]:
    """Return the interfaces that nobody reads or calls, by who offers them, their kind and their owner."""
    found: dict[tuple[object, ...], list[str]] = {}
    for name, one in promised["interfaces"].items():
        if one["sources"] and not one["sinks"]:
            offered_by = tuple(sorted(end["full_name"] for end in one["sources"]))
            found.setdefault((offered_by, one["kind"], one["owner"]), []).append(name)
    return found


@every_build
def test_every_arrow_is_labelled_and_its_text_stays_inside(cell: str, distro: str) -> None:
    promised = contract(cell, distro)
    claims = [c for m in promised["managers"].values() for c in m["controllers"].values() if c["command_interfaces"]]
    drivers = [name for name, one in promised["devices"].items() if one["driver"] is not None]
    picture = sheet(cell, distro)
    said = [entry.text or "" for entry in picture.iter(f"{_SPACE}text")]
    arrows = len(list(picture.iter(f"{_SPACE}line")))
    together = unused(promised)
    alone = {name for names in together.values() for name in names}
    assert set(promised["interfaces"]) - alone <= set(said)
    assert alone <= set(" ".join(said).replace(",", "").split())
    # What moves a device past the controllers has an arrow too, and so has the physical stop.
    used = len(promised["interfaces"]) - len(alone)
    helpers = [
        entry.partition(",")[0] for entry in said if re.fullmatch(r"\S+/\S+, on (real hardware|every target)", entry)
    ]
    assert len(helpers) == said.count("helps")
    launched = "".join(text for name, text in build(cell, distro).texts.items() if name.startswith("launch/"))
    assert all(f'pkg="{name.partition("/")[0]}" exec="{name.partition("/")[2]}"' in launched for name in helpers)
    assert arrows == used + len(together) + len(claims) + len(drivers) + len(helpers) + 1
    assert sum(entry.startswith("owner ") for entry in said) == arrows
    width, height = (float(value) for value in picture.attrib["viewBox"].split()[2:])
    letter = 8.0 * float(picture.attrib["font-size"]) / 13.0
    for entry in picture.iter(f"{_SPACE}text"):
        # 8 units a character of 13 is wider than any sans-serif sets on average.
        assert float(entry.attrib["x"]) + letter * len(entry.text or "") <= width
        assert float(entry.attrib["y"]) <= height


@every_build
def test_boxes_hold_their_names_and_arrows_lie_level(cell: str, distro: str) -> None:
    picture = sheet(cell, distro)
    assert {element.tag.removeprefix(_SPACE) for element in picture.iter()} - _ON_SEVERAL_PAGES == _DRAWN
    assert "href" not in build(cell, distro).texts[f"graph/{SHEET}"]
    assert picture.find(f"{_SPACE}defs/{_SPACE}marker[@id='head']") is not None
    arrows = list(picture.iter(f"{_SPACE}line"))
    assert all(place(arrow, "y1") == place(arrow, "y2") and place(arrow, "x1") < place(arrow, "x2") for arrow in arrows)
    assert {arrow.get("marker-end") for arrow in arrows} == {"url(#head)"}
    boxes = [element for element in picture.iter(f"{_SPACE}rect") if element.get("rx") == "5"]
    assert len(boxes) == 2 * len(arrows)
    for box in boxes:
        left, top, high = place(box, "x", "y", "height")
        places = [place(element, "x", "y") for element in picture.iter(f"{_SPACE}text")]
        lines = [y for x, y in places if x == left + 8 and top < y < top + high]
        assert lines == [top + 16 + 18 * number for number in range(len(lines))]
        assert high == 18 * len(lines) + 8 > 8
    assert len({tuple(box.get(name) for name in ("width", "fill", "stroke")) for box in boxes}) == 1
    styles = {tuple(sorted(set(element.attrib) - {"x", "y"})) for element in picture.iter(f"{_SPACE}text")}
    assert styles == {(), ("fill",), ("font-weight",), ("font-size", "font-weight")}
    assert {element.get("font-weight") for element in picture.iter(f"{_SPACE}text")} == {None, "bold"}
    assert len({element.get("fill") for element in picture.iter(f"{_SPACE}text")} - {None}) == 1
    assert len({place(element, "x") for element in picture.iter(f"{_SPACE}text")}) <= _COLUMNS


@every_build
def test_vendor_control_and_physical_safety_are_bold_and_apart(cell: str, distro: str) -> None:
    bands = [element for element in sheet(cell, distro).iter(f"{_SPACE}rect") if element.get("rx") == "6"]
    assert [band.get("stroke-width") for band in bands] == ["1", "5", "5"]
    edges = [place(band, "y", "height") for band in bands]
    assert all(top + high < below for (top, high), (below, _) in pairwise(edges))


@every_build
def test_arrows_say_what_the_contract_promises(cell: str, distro: str) -> None:
    said = facts(cell, distro)
    together = unused(contract(cell, distro)).values()
    # A name that is longer than its line goes on in the next one.
    listed = "".join(line for lines in said.values() for line in lines).replace(" ", "")
    assert all(",".join(names) in listed for names in together)
    alone = {name for names in together for name in names}
    for name, one in contract(cell, distro)["interfaces"].items():
        if name in alone:
            continue
        lines = " ".join(said[name])
        assert lines.startswith(f"{one['kind']} {one['type']}, "), name
        assert f"owner {one['owner'] or 'not stated'}; " in lines
        assert one["rate_hz"] is None or f" {one['rate_hz']:g} Hz" in lines
        for key in ("frame", "unit", "on_stale", "on_timeout", "on_error"):
            assert one[key] is None or one[key] in lines, (name, key)
        for key in ("max_age_s", "timeout_s", "cancel_within_s"):
            assert one[key] is None or f" {one[key]:g} s" in lines, (name, key)


@every_build
def test_nothing_that_is_known_of_an_arrow_is_called_not_stated(cell: str, distro: str) -> None:
    said = facts(cell, distro)
    for name in {"/tf", "/tf_static", "/robot_description"} & said.keys():
        assert "not stated" not in " ".join(said[name]).replace("owner not stated", ""), name
    # robot_state_publisher's default, which the launch file states.
    assert "/tf" not in said or said["/tf"][0].startswith("topic tf2_msgs/msg/TFMessage, 20 Hz")
    assert re.search('name="publish_frequency" value="20.0"', "".join(build(cell, distro).texts.values()))


@pytest.mark.parametrize("cell", ["ur5e_pick"])
def test_printed_sheet_fits_a4_upright(cell: str) -> None:
    width, height = (float(value) for value in sheet(cell, "jazzy").attrib["viewBox"].split()[2:])
    assert height / width <= 2 * 297 / 210
