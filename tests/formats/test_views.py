"""Pictures from two sides: things stand where they are, names stay apart, and a small change changes little."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import combinations
from xml.etree.ElementTree import Element, fromstring

import pytest

from cellc.compiler.formats.views import Part, two_views
from cellc.contract.transforms import Pose
from cellc.robot.description.model import Box, Cylinder
from tests.cells import ROOT

_SVG = "{http://www.w3.org/2000/svg}"
_UPRIGHT = (0.0, 0.0, 0.0, 1.0)
Box2 = tuple[float, float, float, float]


def _arm(name: str, x: float, y: float, z: float = 0.8) -> Part:
    place = (x, y, z)
    body = Pose((x, y, z + 0.4), _UPRIGHT)
    hand = (x + 0.3, y, z + 0.8)
    tool = Part(
        f"{name}_tool",
        hand,
        ((Pose(hand, _UPRIGHT), Box((0.1, 0.1, 0.1))),),
        frames=((f"{name}_tcp", Pose(hand, _UPRIGHT)),),
    )
    frames = ((f"{name}_base", Pose(place, _UPRIGHT)),)
    return Part(name, place, ((body, Cylinder(0.05, 0.8)),), ((place, hand),), frames, (tool,))


def _cell(*arms: Part) -> Part:
    world = (("world", Pose((0.0, 0.0, 0.0), _UPRIGHT)),)
    return Part("cell", (0.0, 0.0, 0.0), frames=world, parts=arms, solid=True)


def _texts(element: Element, x: float = 0.0, y: float = 0.0) -> Iterator[tuple[Element, float, float]]:
    """Yield every text with where it stands on the sheet."""
    moved = re.fullmatch(r"translate\((\S+) (\S+)\)", element.get("transform", "translate(0 0)"))
    assert moved is not None
    x, y = x + float(moved[1]), y + float(moved[2])
    if element.tag == f"{_SVG}text":
        yield element, x + float(element.attrib["x"]), y + float(element.attrib["y"])
    for child in element:
        yield from _texts(child, x, y)


def _boxes(root: Element) -> Iterator[tuple[str, Box2]]:
    letter = float(root.attrib["font-size"])
    for text, x, y in _texts(root):
        wide = 0.5 * letter * len(text.text or "")  # what Arial sets on average
        left = x - wide * {"start": 0.0, "middle": 0.5, "end": 1.0}[text.get("text-anchor", "start")]
        yield text.text or "", (left, y - 0.7 * letter, left + wide, y)


def _overlapping(root: Element) -> list[tuple[str, str]]:
    return [
        (one, other)
        for (one, a), (other, b) in combinations(_boxes(root), 2)
        if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
    ]


@pytest.mark.parametrize("cell", sorted(path.parent.name for path in ROOT.glob("cells/*/cell.yaml")))
def test_names_of_a_cell_stay_apart_and_on_the_sheet(cell: str) -> None:
    root = fromstring((ROOT / f"generated/{cell}/graph/cell.svg").read_text(encoding="utf-8"))
    assert _overlapping(root) == []
    width, height = (float(value) for value in root.attrib["viewBox"].split()[2:])
    assert [name for name, box in _boxes(root) if box[0] < 0 or box[1] < 0 or box[2] > width or box[3] > height] == []


def test_twenty_arms_have_their_names_and_room_for_them() -> None:
    arms = [_arm(f"arm_{number:02d}", 1.5 * (number % 5), 1.5 * (number // 5)) for number in range(20)]
    root = fromstring(two_views(_cell(*arms)))
    said = [name for name, _ in _boxes(root)]
    assert _overlapping(root) == []
    assert all(f"arm_{number:02d}" in said for number in range(20))
    assert not any("tcp" in name for name in said)


def test_a_frame_stands_where_the_spec_has_it() -> None:
    root = fromstring((ROOT / "generated/ur5e_pick/graph/cell.svg").read_text(encoding="utf-8"))
    front, above = root.findall(f"{_SVG}g")
    places = [
        {name: group.get("transform") for group in view.iter(f"{_SVG}g") for name in _own(group)}
        for view in (front, above)
    ]
    # cells/ur5e_pick/cell.yaml: fixture_A at 450 100 850 mm in world; y of SVG points down.
    assert places[0]["fixture_A"] == "translate(450 -850)"
    assert places[1]["fixture_A"] == "translate(450 -100)"


def _own(group: Element) -> list[str]:
    return [name.strip() for text in group.findall(f"{_SVG}text") for name in (text.text or "").split(",")]


@pytest.mark.parametrize("shift", [0.001, 0.004, 0.007, 0.009])
def test_a_mount_that_moves_changes_at_most_a_line_of_each_view(shift: float) -> None:
    before, after = (two_views(_cell(_arm("arm", x, 0.0), _arm("other", 1.5, 1.0))) for x in (0.0, shift))
    changed = set(after.splitlines()) - set(before.splitlines())
    # The drawing is 1.8 m wide, so that groups stand on every 5 mm.
    x = round(shift / 0.005) * 5
    assert changed == ({f'      <g transform="translate({x:g} {y})">' for y in (-800, 0)} if x else set())


def test_a_name_cannot_leave_its_element() -> None:
    hostile = "</text><script>alert(1)</script>\u2028"
    root = fromstring(
        two_views(_cell(Part(hostile, (0.0, 0.0, 0.0), frames=((hostile, Pose((0.0, 0.0, 0.0), _UPRIGHT)),))))
    )
    assert {element.tag.removeprefix(_SVG) for element in root.iter()} <= {
        "svg",
        "title",
        "g",
        "rect",
        "text",
        "line",
        "polygon",
    }
    assert any("<script>" in name for name, _ in _boxes(root))


@pytest.mark.parametrize("cell", ["rail_arm", "ur5e_pick", "openarm_bimanual"])
def test_no_axis_of_a_frame_runs_into_its_name_as_a_dash_would(cell: str) -> None:
    """A name at the right of its frame, on the red axis, was read as `-tcp`."""
    root = fromstring((ROOT / "generated" / cell / "graph" / "cell.svg").read_text(encoding="utf-8"))
    letter = float(root.attrib["font-size"])
    struck = []
    for group in root.iter(f"{_SVG}g"):
        names = [child for child in group if child.tag == f"{_SVG}text"]
        ends = [float(child.attrib["x2"]) for child in group if child.get("stroke") == "#d62728"]
        for name in names:
            on_axis = -0.1 * letter < float(name.attrib["y"]) < 0.8 * letter
            if (
                on_axis
                and name.get("text-anchor") == "start"
                and 0.0 < float(name.attrib["x"]) < max(ends, default=0.0)
            ):
                struck.append(name.text)
    assert struck == []
