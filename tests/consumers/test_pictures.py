"""The responsibility graph on its sheet and as Mermaid: complete, readable, and the same as the contract."""

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
_DRAWN = {"svg", "defs", "marker", "path", "rect", "text", "line"}


def contract(cell: str, distro: str) -> Any:
    """Return the contract as plain data."""
    return contract_data(build(cell, distro).texts["contract.json"])


def sheet(cell: str, distro: str) -> Element:
    """Return a picture."""
    return fromstring(build(cell, distro).texts[f"graph/{SHEET}"])


def diagram(cell: str, distro: str) -> str:
    """Return the Mermaid text."""
    return build(cell, distro).texts["graph/responsibility.mmd"]


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
    assert arrows == used + len(together) + len(claims) + len(drivers) + 1
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
    assert {one.tag.removeprefix(_SPACE) for one in picture.iter()} == _DRAWN
    assert "href" not in build(cell, distro).texts[f"graph/{SHEET}"]
    assert picture.find(f"{_SPACE}defs/{_SPACE}marker[@id='head']") is not None
    arrows = list(picture.iter(f"{_SPACE}line"))
    assert all(place(one, "y1") == place(one, "y2") and place(one, "x1") < place(one, "x2") for one in arrows)
    assert {one.get("marker-end") for one in arrows} == {"url(#head)"}
    boxes = [one for one in picture.iter(f"{_SPACE}rect") if one.get("rx") == "5"]
    assert len(boxes) == 2 * len(arrows)
    for box in boxes:
        left, top, high = place(box, "x", "y", "height")
        places = [place(one, "x", "y") for one in picture.iter(f"{_SPACE}text")]
        lines = [y for x, y in places if x == left + 8 and top < y < top + high]
        assert lines == [top + 16 + 18 * number for number in range(len(lines))]
        assert high == 18 * len(lines) + 8 > 8
    assert len({tuple(box.get(one) for one in ("width", "fill", "stroke")) for box in boxes}) == 1
    styles = {tuple(sorted(set(one.attrib) - {"x", "y"})) for one in picture.iter(f"{_SPACE}text")}
    assert styles == {(), ("fill",), ("font-weight",), ("font-size", "font-weight")}
    assert {one.get("font-weight") for one in picture.iter(f"{_SPACE}text")} == {None, "bold"}
    assert len({one.get("fill") for one in picture.iter(f"{_SPACE}text")} - {None}) == 1
    assert len({place(one, "x") for one in picture.iter(f"{_SPACE}text")}) <= _COLUMNS


@every_build
def test_vendor_control_and_physical_safety_are_bold_and_apart(cell: str, distro: str) -> None:
    bands = [one for one in sheet(cell, distro).iter(f"{_SPACE}rect") if one.get("rx") == "6"]
    assert [one.get("stroke-width") for one in bands] == ["1", "5", "5"]
    edges = [place(one, "y", "height") for one in bands]
    assert all(top + high < below for (top, high), (below, _) in pairwise(edges))
    text = diagram(cell, distro)
    for boundary in ("vendor", "safety"):
        assert re.search(rf"^  subgraph {boundary}\[", text, re.MULTILINE)
        assert re.search(rf"^  style {boundary} stroke-width:5px", text, re.MULTILINE)


@every_build
def test_sheet_and_diagram_say_the_same_of_every_arrow(cell: str, distro: str) -> None:
    # Without spaces: a name that is longer than its line goes on in the next one.
    said = "".join(one.text or "" for one in sheet(cell, distro).iter(f"{_SPACE}text")).replace(" ", "")
    labels = re.findall(r'"([^"]+)"', diagram(cell, distro).split("  end\n")[-1])
    facts = [fact for label in labels if label.count("<br/>") > 1 for fact in label.split("<br/>")]
    assert len(facts) > 20
    for fact in facts:
        assert fact.replace(" ", "") in said, fact


@every_build
def test_diagram_has_the_ends_and_the_qos_of_the_contract(cell: str, distro: str) -> None:
    text = diagram(cell, distro)
    boxes = re.findall(r"^ *(\w+)\[\"", text, re.MULTILINE)
    assert len(boxes) == len(set(boxes))
    assert len(re.findall("^  subgraph ", text, re.MULTILINE)) == len(re.findall("^  end$", text, re.MULTILINE)) == 3
    for manager in contract(cell, distro)["managers"].values():
        for one in manager["controllers"].values():
            assert f'["{one["full_name"][1:]}<br/>{one["plugin"]}<br/>' in text
    arrows = re.findall(r"^  (\w+) (?:--|==|-\.->)(.*?)(\w+)$", text, re.MULTILINE)
    for start, _, end in arrows:
        assert {start, end} <= set(boxes), (start, end)
    together = unused(contract(cell, distro)).values()
    alone = {name for names in together for name in names}
    assert all(f"<br/>{', '.join(names)}<br/>" in text for names in together)
    for name, one in contract(cell, distro)["interfaces"].items():
        if name in alone:
            continue
        ends = [*one["sources"], *one["sinks"]]
        if len(one["sources"]) == len(one["sinks"]) == 1:
            assert len([label for _, label, _ in arrows if f'"{name}<br/>' in label]) == 1
            continue
        hub = "interface_" + re.sub(r"\W", "_", name)
        met = [label for start, label, end in arrows if hub in (start, end)]
        assert sorted(label.strip(' ->"') for label in met) == sorted(map(_qos, ends)), name


def _qos(end: dict[str, Any]) -> str:
    qos = end["qos"]
    kept = f"last {qos['depth']}" if qos["history"] == "keep_last" else "all"
    return f"{qos['reliability']}, {qos['durability']}, {kept}"


@every_build
def test_nothing_that_is_known_of_an_arrow_is_called_not_stated(cell: str, distro: str) -> None:
    alone = {name for names in unused(contract(cell, distro)).values() for name in names}
    for name in {"/tf", "/tf_static", "/robot_description"} - alone:
        (label,) = re.findall(rf'"({name}<br/>[^"]+)"', diagram(cell, distro))
        assert "not stated" not in label.replace("owner not stated", ""), label
    # robot_state_publisher's default, which the launch file states.
    assert "/tf" in alone or "/tf<br/>topic tf2_msgs/msg/TFMessage, 20 Hz" in diagram(cell, distro)
    assert re.search('name="publish_frequency" value="20.0"', "".join(build(cell, distro).texts.values()))


@pytest.mark.parametrize("cell", ["ur5e_pick"])
def test_printed_sheet_fits_a4_upright(cell: str) -> None:
    width, height = (float(value) for value in sheet(cell, "jazzy").attrib["viewBox"].split()[2:])
    assert height / width <= 2 * 297 / 210
