"""Command, state and error of one joint: what gate G6 asks for, of the mock."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree.ElementTree import Element

import numpy as np

from cellc.contract.contract import ContractJointLimits
from cellc.mock.evidence.trace.envelope import Envelope
from cellc.mock.evidence.trace.run_trace import JointTrace
from cellc.mock.report_page.curve import path
from cellc.mock.report_page.element import svg, tag
from cellc.mock.report_page.figures import small, span
from cellc.mock.report_page.panel import LEFT, RIGHT, WIDTH, TimeAxis, frame, line, text, time_labels
from cellc.mock.report_page.scale import Scale, padded, round_below, ticks

_TOP, _MIDDLE, _LOWER, _BOTTOM, _HEIGHT = 8.0, 112.0, 128.0, 178.0, 196.0
_LEAST_RANGE, _LEAST_ERROR = 0.02, 1e-6
"""rad or m that the axes span at least, so that rounding does not look like motion."""
_PREFIXES = ((1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n"))


@dataclass(frozen=True, slots=True)
class Reach:
    """How a joint used its range: least and greatest position of its state."""

    low: float
    high: float


def joint_plot(
    trace: JointTrace, limits: ContractJointLimits | None, tolerance: float | None, time: TimeAxis
) -> Element:
    """Return the plot of a joint with its name and figures."""
    reach = Reach(*extremes(trace.actual))
    caption = tag("figcaption", tag("b", trace.joint), *_caption(trace, reach, limits, tolerance))
    label = f"{trace.joint}: command, state and error over time"
    drawing = svg(WIDTH, _HEIGHT, label, *_positions(trace, limits, time), *_errors(trace, tolerance, time))
    return tag("figure", caption, drawing, class_="panel")


def _caption(
    trace: JointTrace, reach: Reach, limits: ContractJointLimits | None, tolerance: float | None
) -> Iterator[Element]:
    unit = trace.unit
    yield tag("span", f"state {span(reach.low, reach.high, unit)}")
    yield tag("span", limits_in_words(limits, unit))
    allowed = "" if tolerance is None else f", {small(tolerance, unit)} allowed"
    yield tag("span", f"largest error {small(trace.worst_error, unit)}{allowed}")


def _positions(trace: JointTrace, limits: ContractJointLimits | None, time: TimeAxis) -> Iterator[Element]:
    command = trace.desired if trace.command is None else trace.command
    spans = [extremes(command), extremes(trace.actual)]
    low, high = padded(min(span[0] for span in spans), max(span[1] for span in spans), _LEAST_RANGE)
    y = Scale(low, high, _MIDDLE, _TOP)
    yield from frame(time, y, [(value, f"{value + 0.0:.6g}") for value in ticks(low, high, 4)])
    for bound in () if limits is None else (limits.lower, limits.upper):
        if bound is not None and low < bound < high:
            yield line("limit", time.scale().start, y.place(bound), time.scale().end, y.place(bound))
    yield tag("path", class_="command", d=path(command, time.scale(), y))
    yield tag("path", class_="state", d=path(trace.actual, time.scale(), y))
    yield text("label", LEFT + 4.0, _TOP + 10.0, trace.unit)
    if limits is not None and limits.lower is not None and limits.upper is not None:
        yield from _gauge(limits.lower, limits.upper, Reach(*extremes(trace.actual)))


def _gauge(lower: float, upper: float, reach: Reach) -> Iterator[Element]:
    """Yield a bar from one limit to the other, with the part that was used."""
    y = Scale(lower, upper, _MIDDLE, _TOP)
    place = RIGHT + 9.0
    yield line("range", place, _TOP, place, _MIDDLE)
    middle = y.place((reach.low + reach.high) / 2.0)
    half = max(1.0, abs(y.place(reach.low) - y.place(reach.high)) / 2.0)
    yield line("used", place, middle - half, place, middle + half)


def _errors(trace: JointTrace, tolerance: float | None, time: TimeAxis) -> Iterator[Element]:
    worst = max(trace.worst_error, _LEAST_ERROR)
    step = round_below(1.25 * worst)
    factor, prefix = next((pair for pair in _PREFIXES if step * pair[0] >= 1.0), _PREFIXES[-1])
    y = Scale(-1.25 * worst, 1.25 * worst, _BOTTOM, _LOWER)
    yield from frame(time, y, [(value, f"{value * factor:.4g}") for value in (-step, 0.0, step)])
    for bound in () if tolerance is None or tolerance > 1.25 * worst else (-tolerance, tolerance):
        yield line("limit", time.scale().start, y.place(bound), time.scale().end, y.place(bound))
    yield tag("path", class_="error", d=path(trace.error, time.scale(), y))
    yield text("label", LEFT + 4.0, _LOWER + 10.0, f"error, {prefix}{trace.unit}")
    yield from time_labels(time, _HEIGHT - 4.0)


def extremes(envelope: Envelope) -> tuple[float, float]:
    """Return the least and the greatest value of an envelope of one signal; zeros where it has none."""
    if not np.isfinite(envelope.lowest).any():
        return 0.0, 0.0
    return float(np.nanmin(envelope.lowest)), float(np.nanmax(envelope.highest))


def limits_in_words(limits: ContractJointLimits | None, unit: str) -> str:
    """Return the position limits of a joint."""
    return (
        "no limits stated"
        if limits is None
        else f"limits {_bound(limits.lower)} … {_bound(limits.upper)} {unit}".replace("-", "−")
    )


def _bound(value: float | None) -> str:
    return "∞" if value is None else f"{value:.4g}"
