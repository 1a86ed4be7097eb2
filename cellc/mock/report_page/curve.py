"""The path of a signal: in each column of the drawing its least and its greatest value, so that no peak is lost."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.mock.evidence.trace.envelope import Envelope
from cellc.mock.report_page.scale import Scale


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
