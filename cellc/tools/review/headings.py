"""The heading of an act: another model with what moved, a new measurement with what it found, the largest first."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TypeAlias

from cellc.contract.review import ReviewCause, ReviewChange, ReviewValue
from cellc.tools.review.units import motion, quantity_of

_MODEL, _REVISION, _CALIBRATIONS, _FRAMES = "model", "revision", "calibrations", "frames"
_PLACE = ("xyz", "rpy", "parent")
_PLACED = ("pose in its parent", "base in its parent")
_TIP = "tip"
_MOVING = ((_TIP,), ("pose in its frame",))
_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])")
_MOVES = re.compile(r"(?:moves|turns) ([\d.]+) (mm|m|deg)\b")
_IN_MM = {"mm": 1.0, "m": 1000.0, "deg": 0.0}


Quote: TypeAlias = Callable[[str], str]
"""How a value is written in the heading."""


Deltas: TypeAlias = Mapping[tuple[str | None, ...], str]
"""How much differs, by the values before and after."""


def is_act(cause: ReviewCause) -> bool:
    """Tell whether a cause is another model with what it brings, or a measurement with what it found."""
    lines = [value.line for value in cause.values]
    return cause.line.startswith(f"{_CALIBRATIONS}.") or _MODEL in lines


def parts_of(cause: ReviewCause, quote: Quote, moves: Mapping[str, str], deltas: Deltas) -> Sequence[str]:
    """Return what a heading says of an act, part by part, what counts most first.

    Args:
        quote: how values are written.
        moves: how far things moved, by their name; that of the tip under an empty one.
        deltas: how much values changed, by those before and after.
    """
    places = dict[str, list[ReviewValue]]()
    rest = list[ReviewValue]()
    for value in cause.values:
        at, _, key = value.line.rpartition(".")
        if key in _PLACE and at:
            places.setdefault(at, []).append(value)
        else:
            rest.append(value)
    moved = [
        f"{at} {_past(_move(at, values, moves))}: {', '.join(told)}"
        for at, values in places.items()
        for told in [[_placed(value, quote) for value in sorted(values, key=_order)]]
    ]
    models = [f"{cause.line}.{value.line}: {_pair(value, quote)}" for value in rest if value.line == _MODEL]
    return (*models, *moved, *_others(cause, rest, quote, deltas))


def _others(cause: ReviewCause, rest: Sequence[ReviewValue], quote: Quote, deltas: Deltas) -> Iterator[str]:
    for value in rest:
        line = value.line if value.line.startswith(_CALIBRATIONS) else f"{cause.line}.{value.line}"
        of = line.split(".")
        delta = deltas.get(plain(value.before, value.after), "")
        size = f" ({delta})" if delta else ""
        if of[0] == _CALIBRATIONS and of[-1] == _REVISION:
            yield f"calibration {of[1]} revision {_pair(value, quote)}"
        elif value.line != _MODEL:
            yield f"{of[-1] if of[0] == _CALIBRATIONS else value.line} {_pair(value, quote)}{size}"


def _order(value: ReviewValue) -> int:
    return ("parent", "xyz", "rpy").index(value.line.rpartition(".")[2])


def _placed(value: ReviewValue, quote: Quote) -> str:
    key = value.line.rpartition(".")[2]
    return _pair(value, quote) if key == "xyz" else f"{key} {_pair(value, quote)}"


def _pair(value: ReviewValue, quote: Quote) -> str:
    if value.before is None or value.after is None:
        return f"{quote(value.after or value.before or '')} {'added' if value.before is None else 'removed'}"
    return f"{quote(value.before)} -> {quote(value.after)}"


def _move(at: str, values: Sequence[ReviewValue], moves: Mapping[str, str]) -> str:
    """Return how far something moves: by its own change, else by the figures of its place, else by those of the tip."""
    if at.startswith(f"{_FRAMES}."):
        own = moves.get(at.removeprefix(f"{_FRAMES}."), "")
        return own or moves.get("", "") or "moves"
    told = [text for name, text in moves.items() if name]
    by = _by_figures(values)
    return next((text for text in told if by and text.startswith(by)), "") or by or next(iter(told), "moves")


def _by_figures(values: Sequence[ReviewValue]) -> str:
    xyz = next((value for value in values if value.line.endswith("xyz")), None)
    if xyz is None or xyz.before is None or xyz.after is None:
        return ""
    was, now = quantity_of(xyz.before)[0], quantity_of(xyz.after)[0]
    return motion(math.dist(was, now), 0.0) if was and len(was) == len(now) else ""


def _past(text: str) -> str:
    return text.replace("moves", "moved").replace("turns", "turned")


def moves_of(changes: Sequence[ReviewChange]) -> Mapping[str, str]:
    """Return how far each thing that was placed moves, the farthest first; that of the tip under an empty name."""
    placed = sorted((change for change in changes if change.quantity in _PLACED), key=_far, reverse=True)
    moves = {name: change.delta.partition("; ")[0] for change in placed for name in change.subjects if change.delta}
    tips = sorted((change for change in changes if change.quantity == _TIP), key=_far, reverse=True)
    return {**moves, "": tips[0].delta} if tips else moves


def farthest(changes: Sequence[ReviewChange]) -> tuple[float, float]:
    """Return how far, in mm and in degrees, what was placed moves; else the tip, else a goal."""
    of_each = ([change for change in changes if change.quantity in quantities] for quantities in (_PLACED, *_MOVING))
    return max(map(_far, next(filter(None, of_each), [])), default=(0.0, 0.0))


def _far(change: ReviewChange) -> tuple[float, float]:
    found = _MOVES.findall(change.delta.partition("; ")[0])
    lengths = [float(figure) * _IN_MM[unit] for figure, unit in found if unit != "deg"]
    turns = [float(figure) for figure, unit in found if unit == "deg"]
    return max(lengths, default=0.0), max(turns, default=0.0)


def plain(*values: str | None) -> tuple[str | None, ...]:
    """Return values with their numbers in one spelling: `2.0 kg` is `2 kg`."""
    return tuple(
        None if value is None else _NUMBER.sub(lambda number: f"{float(number[0]):.12g}", value) for value in values
    )
