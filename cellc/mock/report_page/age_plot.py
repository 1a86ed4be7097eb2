"""The age of one stream of messages for who consumes it, against the oldest that may be used."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.mock.evidence.trace.age_builder import AgeTrace
from cellc.mock.report_page.curve import path
from cellc.mock.report_page.element import svg, tag
from cellc.mock.report_page.figures import seconds
from cellc.mock.report_page.panel import WIDTH, TimeAxis, frame, line, time_labels
from cellc.mock.report_page.scale import Scale, ticks

_TOP, _BOTTOM, _HEIGHT = 8.0, 84.0, 102.0


def age_plot(trace: AgeTrace, time: TimeAxis) -> Element:
    """Return the plot of a stream with its worst age and its bound."""
    bound = "no bound stated" if trace.max_age_s is None else f"{seconds(trace.max_age_s)} allowed"
    over = trace.max_age_s is not None and trace.worst_s is not None and trace.worst_s > trace.max_age_s
    worst = tag("span", f"oldest {seconds(trace.worst_s)}", class_="bad" if over else "plain")
    caption = tag("figcaption", tag("b", trace.source), worst, tag("span", bound), tag("span", f"for {trace.consumer}"))
    drawing = svg(WIDTH, _HEIGHT, f"age of {trace.source} over time", *_content(trace, time))
    return tag("figure", caption, drawing, class_="panel")


def _content(trace: AgeTrace, time: TimeAxis) -> Iterator[Element]:
    highest = max(trace.worst_s or 0.0, trace.max_age_s or 0.0, 1e-3) * 1.15
    y = Scale(0.0, highest, _BOTTOM, _TOP)
    values = ticks(0.0, highest, 3)
    yield from frame(time, y, [(value, _label(value, value == values[-1])) for value in values])
    if trace.max_age_s is not None:
        yield line("limit", time.scale().start, y.place(trace.max_age_s), time.scale().end, y.place(trace.max_age_s))
    yield tag("path", class_="age", d=path(trace.envelope, time.scale(), y))
    yield from time_labels(time, _HEIGHT - 4.0)


def _label(value_s: float, last: bool) -> str:
    return f"{value_s * 1e3:g} ms" if last else f"{value_s * 1e3:g}"
