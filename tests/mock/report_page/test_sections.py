"""What single sections of the report show, asked without a run."""

from __future__ import annotations

import re
from xml.etree.ElementTree import tostring

import pytest

from cellc.mock.campaign.summary import Matrix
from cellc.mock.report_page.axes import TimeAxis
from cellc.mock.report_page.html import cards, plain, seconds, style, tag
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


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("`arm` moves `a/b`", "<p><code>arm</code> moves <code>a/b</code></p>"),
        ("a ` alone", "<p>a ` alone</p>"),
        ("`<b>`", "<p><code>&lt;b&gt;</code></p>"),
    ],
)
def test_text_between_backticks_is_code(text: str, shown: str) -> None:
    assert tostring(tag("p", text), encoding="unicode") == shown
    assert "".join(tag("pre", text).itertext()) == text


def test_a_card_has_its_text_in_one_piece_beside_its_name() -> None:
    (cell,) = cards(("why",), [("`arm` waits",)]).iter("td")
    assert tostring(cell, encoding="unicode") == '<td data-name="why"><span><code>arm</code> waits</span></td>'


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        (0.000857979, "rad or m", "858 µrad or µm"),
        (0.077, "m", "77 mm"),
        (0.0, "rad", "0 rad"),
        (0.05333, "s", "53.3 ms"),
        (11.71875, "Hz", "11.72 Hz"),
        (123456.0, "cycles", "123456 cycles"),
        (1.0, "events", "1 event"),
        (0.5, "share", "50%"),
        (float("inf"), "Hz", "inf Hz"),
        (None, "s", "–"),
    ],
)
def test_figures_have_a_unit_that_suits_them(value: float | None, unit: str, words: str) -> None:
    assert plain(value, unit) == words


def test_a_time_that_rounding_made_is_not_told_in_millionths() -> None:
    assert (seconds(1.25e-7), seconds(0.0), seconds(2e-6)) == ("below 1 µs", "0 ms", "0.002 ms")


def _luminance(color: str) -> float:
    parts = (int(color[at : at + 2], 16) / 255.0 for at in (1, 3, 5))
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


@pytest.mark.parametrize("scheme", [0, 1], ids=["light", "dark"])
def test_text_is_legible_in_both_schemes(scheme: int) -> None:
    colors = dict(re.findall(r"--(\w+): (#\w{6})", re.findall(r":root \{([^}]*--paper[^}]*)\}", style())[scheme]))
    for text in ("ink", "quiet", "good", "bad", "limit"):
        for behind in ("paper", "soft"):
            darker, lighter = sorted((_luminance(colors[text]), _luminance(colors[behind])))
            assert (lighter + 0.05) / (darker + 0.05) >= 4.5, (text, behind)


def test_paper_keeps_what_a_screen_shows() -> None:
    printed = style().split("@media print")[1]
    assert "print-color-adjust: exact" in printed  # bars are backgrounds
    assert "details::details-content { content-visibility: visible" in printed
