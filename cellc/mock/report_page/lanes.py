"""Spans of time as bars along one axis; they bend to the width of the page, so that their words stay legible."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from cellc.mock.report_page.element import tag
from cellc.mock.report_page.panel import TimeAxis
from cellc.mock.report_page.scale import ticks


@dataclass(frozen=True, slots=True)
class Bar:
    """A span of a lane; the kind decides its colour, the words are read out where one points at it."""

    from_s: float
    until_s: float
    kind: str
    words: str


def lane(title: Sequence[Element | str], bars: Sequence[Bar], time: TimeAxis) -> Element:
    """Return a lane: its title, and its bars on the axis of the run."""
    track = tag(
        "div", *(_bar(each, time) for each in bars), *(_fault(at_s, time) for at_s in time.faults_s), class_="track"
    )
    return tag("div", tag("div", *title, class_="lane-title"), track, class_="lane")


def axis(time: TimeAxis) -> Element:
    """Return the axis below lanes."""
    values = ticks(time.start_s, time.end_s, 6)
    marks = [
        tag("span", f"{value:g}" + (" s" if value == values[-1] else ""), style=f"left:{_percent(value, time)}")
        for value in values
    ]
    return tag("div", tag("div", class_="lane-title"), tag("div", *marks, class_="axis"), class_="lane")


def _bar(bar: Bar, time: TimeAxis) -> Element:
    left, right = _share(bar.from_s, time), _share(bar.until_s, time)
    style = f"left:{left:.2f}%;width:{max(right - left, 0.4):.2f}%"
    return tag("span", class_=f"bar {bar.kind}", style=style, title=bar.words)


def _fault(at_s: float, time: TimeAxis) -> Element:
    return tag("span", class_="fault-mark", style=f"left:{_percent(at_s, time)}", title=f"fault at {at_s:.3f} s")


def _percent(at_s: float, time: TimeAxis) -> str:
    return f"{_share(at_s, time):.2f}%"


def _share(at_s: float, time: TimeAxis) -> float:
    share = (at_s - time.start_s) / (time.end_s - time.start_s)
    return 100.0 * min(1.0, max(0.0, share))
