"""Axes of the plots: scales with round values, the path of a signal, grid lines, faults and attempts over time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element

from cellc.contract.frozen import dataclass
from cellc.mock.evidence.envelope import Envelope
from cellc.mock.report_page.html import tag

WIDTH, LEFT, RIGHT = 420.0, 52.0, 402.0


@dataclass(frozen=True, slots=True)
class Scale:
    """Maps ``low`` … ``high`` linearly to ``start`` … ``end``."""

    low: float
    high: float
    start: float
    end: float

    def place(self, value: float) -> float:
        """Return the place of a value."""
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)


def ticks(low: float, high: float, most: int) -> list[float]:
    """Return round values inside a range: steps of 1, 2 or 5 times a power of ten."""
    raw = (high - low) / most
    magnitude = 10.0 ** math.floor(math.log10(raw))
    step = next(factor * magnitude for factor in (1.0, 2.0, 5.0, 10.0) if factor * magnitude >= raw * (1.0 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [index * step for index in range(first, last + 1)]


def round_below(value: float) -> float:
    """Return the greatest of 1, 2 and 5 times a power of ten that is not above a value."""
    magnitude = 10.0 ** math.floor(math.log10(value))
    return next(factor * magnitude for factor in (5.0, 2.0, 1.0) if factor * magnitude <= value * (1.0 + 1e-9))


def padded(low: float, high: float, least: float) -> tuple[float, float]:
    """Return a range with a margin of an eighth, and at least ``least`` wide."""
    half = max((high - low) * 0.625, least / 2.0)
    middle = (low + high) / 2.0
    return middle - half, middle + half


@dataclass(slots=True)
class _Column:
    """What a signal did within one column of the drawing."""

    place: int
    from_ns: int
    until_ns: int
    low: float
    high: float


def path(envelope: Envelope, x: Scale, y: Scale) -> str:
    """Return the ``d`` of a path; it is broken where nothing was sampled.

    Args:
        envelope: of one signal, times in ns.
        x: from seconds to columns.
        y: from values to rows.
    """
    pieces: list[str] = []
    ended_ns, row = -1, 0.0
    for column in _columns(envelope, x):
        low, high = round(y.place(column.low), 1), round(y.place(column.high), 1)
        # The nearer end first: what rises is drawn upwards, what falls downwards.
        near, far = (low, high) if abs(low - row) <= abs(high - row) else (high, low)
        if ended_ns != column.from_ns:
            pieces += [f"M{column.place} {near}", f"V{far}"]
        elif near == far == row:
            pieces.append(f"H{column.place}")
        elif min(row, far) <= near <= max(row, far):  # a straight line to the far end passes the near one
            pieces.append(f"L{column.place} {far}")
        else:
            pieces += [f"L{column.place} {near}", f"V{far}"]
        row, ended_ns = far, column.until_ns
    return "".join(_without_stops(pieces))


def _columns(envelope: Envelope, x: Scale) -> Iterator[_Column]:
    column: _Column | None = None
    lows, highs = envelope.lowest[:, 0].tolist(), envelope.highest[:, 0].tolist()
    for start_ns, low, high in zip(envelope.starts_ns.tolist(), lows, highs, strict=True):
        if low != low:  # NaN: no sample of this signal
            continue
        place = round(x.place((start_ns + envelope.width_ns / 2) / 1e9))
        if column is not None and column.place == place and column.until_ns == start_ns:
            column.low, column.high = min(column.low, low), max(column.high, high)
            column.until_ns = start_ns + envelope.width_ns
            continue
        if column is not None:
            yield column
        column = _Column(place, start_ns, start_ns + envelope.width_ns, low, high)
    if column is not None:
        yield column


def _without_stops(pieces: list[str]) -> Iterator[str]:
    """Leave out the stops of a straight horizontal line."""
    for piece, following in zip(pieces, [*pieces[1:], ""], strict=True):
        if not (piece.startswith("H") and following.startswith("H")):
            yield piece


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
