"""The position of a joint that no trajectory controller drives, against its limits."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.contract.contract import ContractJointLimits
from cellc.mock.evidence.trace.run_trace import StateTrace
from cellc.mock.report_page.curve import path
from cellc.mock.report_page.element import svg, tag
from cellc.mock.report_page.figures import span
from cellc.mock.report_page.joint_plot import extremes, limits_in_words
from cellc.mock.report_page.panel import LEFT, WIDTH, TimeAxis, frame, line, text, time_labels
from cellc.mock.report_page.scale import Scale, padded, ticks

_TOP, _BOTTOM, _HEIGHT = 8.0, 84.0, 102.0
_LEAST_RANGE = 0.01
"""rad or m that the axis spans at least."""


def state_plot(trace: StateTrace, limits: ContractJointLimits | None, time: TimeAxis) -> Element:
    """Return the plot of a joint with its name and range."""
    low, high = extremes(trace.state)
    reach = tag("span", f"state {span(low, high, trace.unit)}")
    caption = tag("figcaption", tag("b", trace.joint), reach, tag("span", limits_in_words(limits, trace.unit)))
    drawing = svg(WIDTH, _HEIGHT, f"{trace.joint}: state over time", *_content(trace, limits, time))
    return tag("figure", caption, drawing, class_="panel")


def _content(trace: StateTrace, limits: ContractJointLimits | None, time: TimeAxis) -> Iterator[Element]:
    low, high = padded(*extremes(trace.state), _LEAST_RANGE)
    y = Scale(low, high, _BOTTOM, _TOP)
    yield from frame(time, y, [(value, f"{value + 0.0:.6g}") for value in ticks(low, high, 3)])
    for bound in () if limits is None else (limits.lower, limits.upper):
        if bound is not None and low < bound < high:
            yield line("limit", time.scale().start, y.place(bound), time.scale().end, y.place(bound))
    yield tag("path", class_="state", d=path(trace.state, time.scale(), y))
    yield text("label", LEFT + 4.0, _TOP + 10.0, trace.unit)
    yield from time_labels(time, _HEIGHT - 4.0)
