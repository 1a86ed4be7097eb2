"""What single sections of the report show, asked without a run."""

from __future__ import annotations

from xml.etree.ElementTree import tostring

import pytest

from cellc.mock.campaign.summary import Matrix
from cellc.mock.report_page.axes import TimeAxis
from cellc.mock.report_page.page import _table
from cellc.mock.report_page.run_section import Bar, lane

_TIME = TimeAxis(10.0, 20.0, (), ())


@pytest.mark.parametrize(
    ("from_s", "until_s", "style"),
    [
        (12.0, 15.0, "left:20.00%;width:30.00%"),
        (10.0, 20.0, "left:0.00%;width:100.00%"),
        (5.0, 12.0, "left:0.00%;width:20.00%"),  # what began before the axis begins with it
        (9.0, 9.5, "left:0.00%;width:0.40%"),
        (18.0, 30.0, "left:80.00%;width:20.00%"),
        (21.0, 22.0, "left:100.00%;width:0.40%"),
        (15.0, 15.0, "left:50.00%;width:0.40%"),  # never too narrow to be seen
    ],
)
def test_bar_lies_within_its_lane(from_s: float, until_s: float, style: str) -> None:
    (bar,) = lane(["a"], [Bar(from_s, until_s, "move", "words")], _TIME).iter("span")
    assert bar.attrib == {"class": "bar move", "style": style, "title": "words"}


@pytest.mark.parametrize(
    ("at_s", "left"), [(10.0, "0.00"), (12.5, "25.00"), (20.0, "100.00"), (9.0, "0.00"), (30.0, "100.00")]
)
def test_mark_of_a_fault_lies_within_its_lane(at_s: float, left: str) -> None:
    (mark,) = lane(["a"], [], TimeAxis(10.0, 20.0, (at_s,), ())).iter("span")
    assert mark.attrib == {"class": "fault-mark", "style": f"left:{left}%", "title": f"fault at {at_s:.3f} s"}


@pytest.mark.parametrize("steps", [(), ("move home",), ("move home", "detect object", "move pick")])
def test_steps_of_a_campaign_are_counted_from_one_as_everywhere(steps: tuple[str, ...]) -> None:
    table = _table(Matrix("pick", steps, (("stop:arm", ((),) * len(steps)),)))
    heads = ["".join(head.itertext()) for head in table.iter("th")]
    assert heads == ["pick", *(f"{number} {title}" for number, title in zip((1, 2, 3), steps, strict=False))]
    cells = ["".join(cell.itertext()) for cell in table.iter("td")]
    assert cells == ["stop:arm", *("–" for _ in steps)]
    assert tostring(table, encoding="unicode").startswith('<div class="wide"><table class="matrix"><thead>')
