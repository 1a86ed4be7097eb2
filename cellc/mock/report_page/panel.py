"""One set of axes: frame, grid, labels, and what lies over all plots of a run, its faults and its attempts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from cellc.mock.report_page.element import tag
from cellc.mock.report_page.scale import Scale, ticks

WIDTH, LEFT, RIGHT = 420.0, 52.0, 402.0


@dataclass(frozen=True, slots=True)
class TimeAxis:
    """Simulated time of a run, with the instants at which faults began and attempts were made.

    Attributes:
        attempts_s: begin and end of each attempt.
    """

    start_s: float
    end_s: float
    faults_s: tuple[float, ...]
    attempts_s: tuple[tuple[float, float], ...]

    def scale(self) -> Scale:
        """Return the scale of all plots of the run."""
        return Scale(self.start_s, self.end_s, LEFT, RIGHT)


def frame(time: TimeAxis, y: Scale, labels: Sequence[tuple[float, str]]) -> Iterator[Element]:
    """Yield attempts as shades, grid lines with labels, and faults as lines across."""
    x = time.scale()
    top, height = min(y.start, y.end), abs(y.end - y.start)
    for begin_s, end_s in time.attempts_s[::2]:
        width = max(0.5, x.place(end_s) - x.place(begin_s))
        yield tag("rect", class_="shade", x=_px(x.place(begin_s)), y=_px(top), width=_px(width), height=_px(height))
    for value, label in labels:
        row = y.place(value)
        yield line("grid", LEFT, row, RIGHT, row)
        yield text("label", LEFT - 5.0, row + 3.5, label, anchor="end")
    for fault_s in time.faults_s:
        yield line("fault", x.place(fault_s), top, x.place(fault_s), top + height)


def time_labels(time: TimeAxis, row: float) -> Iterator[Element]:
    """Yield the labels of the time axis below a plot."""
    x = time.scale()
    values = ticks(time.start_s, time.end_s, 6)
    for value in values:
        unit = " s" if value == values[-1] else ""
        yield text("label", x.place(value), row, f"{value:g}{unit}", anchor="middle")


def line(class_: str, x1: float, y1: float, x2: float, y2: float) -> Element:
    """Return a straight line."""
    return tag("line", class_=class_, x1=_px(x1), y1=_px(y1), x2=_px(x2), y2=_px(y2))


def text(class_: str, x: float, y: float, words: str, *, anchor: str = "start") -> Element:
    """Return a line of text."""
    return tag("text", words, class_=class_, x=_px(x), y=_px(y), text_anchor=anchor)


def _px(value: float) -> str:
    return f"{value:.1f}"
