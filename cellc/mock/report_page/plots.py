"""Plots over the time of a run: a joint with its command, state and error; a state; the age of a stream."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol
from xml.etree.ElementTree import Element

from cellc.contract.contract import Contract, ContractJointLimits
from cellc.mock.evidence.envelope import AgeTrace
from cellc.mock.evidence.run_trace import JointTrace, StateTrace
from cellc.mock.report_page.axes import (
    LEFT,
    RIGHT,
    WIDTH,
    Scale,
    TimeAxis,
    frame,
    line,
    padded,
    path,
    round_below,
    text,
    ticks,
    time_labels,
)
from cellc.mock.report_page.html import PREFIXES, Child, seconds, small, span, svg, tag

_TOP = 8.0
# Of a joint: positions between _TOP and _MIDDLE, its error between _LOWER and _ERROR_BOTTOM.
_MIDDLE, _LOWER, _ERROR_BOTTOM, _JOINT_HEIGHT = 112.0, 128.0, 178.0, 196.0
# Of a state or an age.
_BOTTOM, _HEIGHT = 84.0, 102.0
_LEAST_JOINT_RANGE, _LEAST_STATE_RANGE, _LEAST_ERROR = 0.02, 0.01, 1e-6
"""rad or m that the axes span at least, so that rounding does not look like motion."""


class Plotted(Protocol):
    """What is drawn over time: of a rehearsal, or of a bag."""

    @property
    def joints(self) -> Sequence[JointTrace]:
        """Joints of trajectory controllers."""

    @property
    def states(self) -> Sequence[StateTrace]:
        """Joints that no trajectory controller drives."""

    @property
    def ages(self) -> Sequence[AgeTrace]:
        """Streams."""


def plots(
    plotted: Plotted, contract: Contract, tolerances: Mapping[str, float], time: TimeAxis, mark: str
) -> Iterator[Element]:
    """Yield the plots under their titles.

    Args:
        tolerances: path tolerance of each joint that has one, rad or m.
        mark: what a dotted line shows.
    """
    if plotted.joints:
        yield tag("h3", "Command, state and error of each joint")
        yield tag("p", *_legend(mark), class_="hint legend")
        panels = [
            joint_plot(each, contract.joint_limits.get(each.joint), tolerances.get(each.joint), time)
            for each in plotted.joints
        ]
        yield tag("div", *panels, class_="grid")
    if plotted.states:
        yield tag("h3", "State of joints that no trajectory controller drives")
        panels = [state_plot(each, contract.joint_limits.get(each.joint), time) for each in plotted.states]
        yield tag("div", *panels, class_="grid")
    if plotted.ages:
        yield tag("h3", "Ages of messages and transforms")
        yield tag("div", *(age_plot(each, time) for each in plotted.ages), class_="grid")


def _legend(mark: str) -> Iterator[Child]:
    for class_, words in (("command", "command"), ("state", "state"), ("error", "error = reference − state")):
        yield tag("span", class_=f"key {class_}")
        yield f"{words} "
    yield tag("span", class_="key limit")
    yield "limit or tolerance "
    yield tag("span", class_="key fault")
    yield f"{mark}. Shaded: every other attempt. The bar at the right spans the limits; the thick part was used."


def joint_plot(
    trace: JointTrace, limits: ContractJointLimits | None, tolerance: float | None, time: TimeAxis
) -> Element:
    """Return the plot of a joint with its name and figures."""
    caption = tag("figcaption", tag("b", trace.joint), *_caption(trace, limits, tolerance))
    label = f"{trace.joint}: command, state and error over time"
    drawing = svg(WIDTH, _JOINT_HEIGHT, label, *_positions(trace, limits, time), *_errors(trace, tolerance, time))
    return tag("figure", caption, drawing, class_="panel")


def _caption(trace: JointTrace, limits: ContractJointLimits | None, tolerance: float | None) -> Iterator[Element]:
    unit = trace.unit
    yield tag("span", f"state {span(*trace.actual.extremes, unit)}")
    yield tag("span", _limits_in_words(limits, unit))
    allowed = "" if tolerance is None else f", {small(tolerance, unit)} allowed"
    yield tag("span", f"largest error {small(trace.worst_error, unit)}{allowed}")


def _positions(trace: JointTrace, limits: ContractJointLimits | None, time: TimeAxis) -> Iterator[Element]:
    command = trace.desired if trace.command is None else trace.command
    spans = [command.extremes, trace.actual.extremes]
    low, high = padded(min(span[0] for span in spans), max(span[1] for span in spans), _LEAST_JOINT_RANGE)
    y = Scale(low, high, _MIDDLE, _TOP)
    yield from _position_axes(time, y, limits, 4)
    yield tag("path", class_="command", d=path(command, time.scale(), y))
    yield tag("path", class_="state", d=path(trace.actual, time.scale(), y))
    yield text("label", LEFT + 4.0, _TOP + 10.0, trace.unit)
    if limits is not None and limits.lower is not None and limits.upper is not None:
        yield from _gauge(limits.lower, limits.upper, *trace.actual.extremes)


def _gauge(lower: float, upper: float, least: float, greatest: float) -> Iterator[Element]:
    """Yield a bar from one limit to the other, with the part that was used."""
    y = Scale(lower, upper, _MIDDLE, _TOP)
    place = RIGHT + 9.0
    yield line("range", place, _TOP, place, _MIDDLE)
    middle = y.place((least + greatest) / 2.0)
    half = max(1.0, abs(y.place(least) - y.place(greatest)) / 2.0)
    yield line("used", place, middle - half, place, middle + half)


def _errors(trace: JointTrace, tolerance: float | None, time: TimeAxis) -> Iterator[Element]:
    worst = max(trace.worst_error, _LEAST_ERROR)
    step = round_below(1.25 * worst)
    factor, prefix = next((pair for pair in PREFIXES if step * pair[0] >= 1.0), PREFIXES[-1])
    y = Scale(-1.25 * worst, 1.25 * worst, _ERROR_BOTTOM, _LOWER)
    yield from frame(time, y, [(value, f"{value * factor:.4g}") for value in (-step, 0.0, step)])
    for bound in () if tolerance is None or tolerance > 1.25 * worst else (-tolerance, tolerance):
        yield _limit_line(time, y, bound)
    yield tag("path", class_="error", d=path(trace.error, time.scale(), y))
    yield text("label", LEFT + 4.0, _LOWER + 10.0, f"error, {prefix}{trace.unit}")
    yield from time_labels(time, _JOINT_HEIGHT - 4.0)


def state_plot(trace: StateTrace, limits: ContractJointLimits | None, time: TimeAxis) -> Element:
    """Return the plot of a joint with its name and range."""
    low, high = trace.state.extremes
    reach = tag("span", f"state {span(low, high, trace.unit)}")
    caption = tag("figcaption", tag("b", trace.joint), reach, tag("span", _limits_in_words(limits, trace.unit)))
    drawing = svg(WIDTH, _HEIGHT, f"{trace.joint}: state over time", *_state_content(trace, limits, time))
    return tag("figure", caption, drawing, class_="panel")


def _state_content(trace: StateTrace, limits: ContractJointLimits | None, time: TimeAxis) -> Iterator[Element]:
    low, high = padded(*trace.state.extremes, _LEAST_STATE_RANGE)
    y = Scale(low, high, _BOTTOM, _TOP)
    yield from _position_axes(time, y, limits, 3)
    yield tag("path", class_="state", d=path(trace.state, time.scale(), y))
    yield text("label", LEFT + 4.0, _TOP + 10.0, trace.unit)
    yield from time_labels(time, _HEIGHT - 4.0)


def age_plot(trace: AgeTrace, time: TimeAxis) -> Element:
    """Return the plot of a stream with its worst age and its bound."""
    bound = "no bound stated" if trace.max_age_s is None else f"{seconds(trace.max_age_s)} allowed"
    over = trace.max_age_s is not None and trace.worst_s is not None and trace.worst_s > trace.max_age_s
    worst = tag("span", f"oldest {seconds(trace.worst_s)}", class_="bad" if over else "plain")
    caption = tag("figcaption", tag("b", trace.source), worst, tag("span", bound), tag("span", f"for {trace.consumer}"))
    drawing = svg(WIDTH, _HEIGHT, f"age of {trace.source} over time", *_age_content(trace, time))
    return tag("figure", caption, drawing, class_="panel")


def _age_content(trace: AgeTrace, time: TimeAxis) -> Iterator[Element]:
    highest = max(trace.worst_s or 0.0, trace.max_age_s or 0.0, 1e-3) * 1.15
    y = Scale(0.0, highest, _BOTTOM, _TOP)
    values = ticks(0.0, highest, 3)
    yield from frame(time, y, [(value, _label(value, value == values[-1])) for value in values])
    if trace.max_age_s is not None:
        yield _limit_line(time, y, trace.max_age_s)
    yield tag("path", class_="age", d=path(trace.envelope, time.scale(), y))
    yield from time_labels(time, _HEIGHT - 4.0)


def _label(value_s: float, last: bool) -> str:
    return f"{value_s * 1e3:g} ms" if last else f"{value_s * 1e3:g}"


def _position_axes(time: TimeAxis, y: Scale, limits: ContractJointLimits | None, most: int) -> Iterator[Element]:
    """Yield the frame of a plot of positions with at most so many labels, and the limits that lie inside it."""
    yield from frame(time, y, [(value, f"{value + 0.0:.6g}") for value in ticks(y.low, y.high, most)])
    for bound in () if limits is None else (limits.lower, limits.upper):
        if bound is not None and y.low < bound < y.high:
            yield _limit_line(time, y, bound)


def _limit_line(time: TimeAxis, y: Scale, value: float) -> Element:
    return line("limit", time.scale().start, y.place(value), time.scale().end, y.place(value))


def _limits_in_words(limits: ContractJointLimits | None, unit: str) -> str:
    """Return the position limits of a joint."""
    return (
        "no limits stated"
        if limits is None
        else f"limits {_bound(limits.lower)} … {_bound(limits.upper)} {unit}".replace("-", "−")
    )


def _bound(value: float | None) -> str:
    return "∞" if value is None else f"{value:.4g}"
