"""Which act is the largest: by what its line of the spec is of, from another device to what is only noted."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from enum import IntEnum

from cellc.contract.review import ReviewCause
from cellc.contract.vocabulary import ReviewArea
from cellc.tools.review.headings import is_act
from cellc.tools.review.titles import WHOLE_SPEC


class Rank(IntEnum):
    """What a line of the spec is of, the largest act first."""

    DEVICE = 0
    """Another device or model."""
    BASE = 1
    """Where a device is mounted, and which program runs where."""
    AUTHORITY = 2
    """What stops, who commands and owns, and what happens after a fault."""
    PLACE = 3
    """Where things are around the arms."""
    LIMIT = 4
    """Bounds of motion and of force."""
    GOAL = 5
    """Named poses and goals."""
    NAME = 6
    """Addresses, versions, and how nodes exchange data."""
    LOAD = 7
    """Payload, measurements, clocks and rates."""
    TUNING = 8
    """Tolerances, timeouts, gains and parameters."""
    NOTE = 9
    """What rests on others or is noted: first motion, rehearsals, open questions, scheduling."""


_DEVICE, _INTERFACE, _NODE = r"devices\.[^.]+", r"interfaces\.[^.]+", r"nodes\.[^.]+"
_MANAGER = r"(?:control|managers\.[^.]+)"
_CONTROLLER = rf"{_MANAGER}\.controllers\.[^.]+"
_RANKS: Sequence[tuple[Rank, re.Pattern[str]]] = tuple(
    (rank, re.compile(rf"(?:{pattern})(?:\.|$)"))
    for rank, pattern in (
        (Rank.NOTE, r"bringup\.first_motion|rehearsals|kpis|uncertainty|regions|recording|summary|surroundings"),
        (Rank.NOTE, r".*\.(?:scheduling|executor|threads|respawn|language)|.*(?:priority|affinity)"),
        (Rank.DEVICE, rf"{_DEVICE}(?:$|\.model)"),
        (Rank.BASE, rf"{_DEVICE}\.(?:mount|connection\.host)|{_NODE}(?:$|\.(?:run|host|namespace))"),
        (Rank.BASE, rf"hosts\.[^.]+$|{_MANAGER}\.(?:host|namespace)"),
        (Rank.AUTHORITY, rf"safety|owners|areas|targets|mock_\w+|bringup\.gates|managers\.[^.]+$|{_MANAGER}\.switches"),
        (Rank.AUTHORITY, rf"{_DEVICE}\.(?:architecture|program|collision|switching|adapter\.(?:run|\w+_time(?:out)?))"),
        (Rank.AUTHORITY, rf"{_INTERFACE}\.(?:on_\w+|cancel_within|server|client)|.*\.(?:owner|published_by)"),
        (Rank.AUTHORITY, rf"{_CONTROLLER}(?:$|\.(?:type|device|joints|command_interfaces|active|client|on_violation))"),
        (Rank.LIMIT, rf"{_DEVICE}\.(?:limits|grip)|bringup\.commissioning|motion\.servo"),
        (Rank.NAME, rf"{_DEVICE}\.(?:connection|prefix|revision|serial|firmware|driver|sdk|description)"),
        (Rank.TUNING, rf"{_DEVICE}\.(?:impedance|adapter)|{_CONTROLLER}|{_NODE}|{_INTERFACE}\.timeout"),
        (Rank.LOAD, rf"{_DEVICE}\.\w+|hosts\.[^.]+\.clock|frames\.[^.]+\.(?:rate|buffer|grasp|simulated_pose)"),
        (Rank.LOAD, rf"{_MANAGER}|{_INTERFACE}\.rate"),
        (Rank.PLACE, r"frames|scene|calibrations|motion\.groups"),
        (Rank.GOAL, "motion"),
        (Rank.NAME, "versions|network|hosts|interfaces|packages|cell|include"),
    )
)
"""The first that fits the path of a line counts."""

_OF_AREA: Mapping[ReviewArea, Rank] = {
    ReviewArea.SAFETY: Rank.AUTHORITY,
    ReviewArea.GATES: Rank.AUTHORITY,
    ReviewArea.OWNERS: Rank.AUTHORITY,
    ReviewArea.CONTROL: Rank.AUTHORITY,
    ReviewArea.START_ORDER: Rank.AUTHORITY,
    ReviewArea.DEVICES: Rank.DEVICE,
    ReviewArea.MODEL: Rank.BASE,
    ReviewArea.FRAMES: Rank.PLACE,
    ReviewArea.LIMITS: Rank.LIMIT,
    ReviewArea.MOTION: Rank.GOAL,
    ReviewArea.INTERFACES: Rank.NAME,
    ReviewArea.QOS: Rank.NAME,
    ReviewArea.NETWORK: Rank.NAME,
    ReviewArea.VERSIONS: Rank.NAME,
    ReviewArea.PAYLOAD: Rank.LOAD,
    ReviewArea.CALIBRATION: Rank.LOAD,
    ReviewArea.TIME: Rank.LOAD,
}
"""Of what has no line of the spec; of other areas it is a note."""


def rank_of(cause: ReviewCause | None, area: ReviewArea) -> Rank:
    """Return how large an act is: by the largest of its lines, of what is no line of a spec by its area."""
    if cause is not None and cause.line.startswith("calibrations"):
        return Rank.PLACE
    ranks = [rank for path in _paths(cause) if (rank := _of_path(path)) is not None] if cause is not None else []
    return min(ranks, default=_OF_AREA.get(area, Rank.NOTE))


def _of_path(path: str) -> Rank | None:
    return next((rank for rank, pattern in _RANKS if pattern.match(path)), None)


def _paths(cause: ReviewCause) -> Iterator[str]:
    """Yield the whole paths of the lines of a cause."""
    if not cause.values:
        yield cause.line
    for value in cause.values:
        is_whole = cause.line == WHOLE_SPEC or (is_act(cause) and value.line.startswith("calibrations."))
        yield value.line if is_whole else f"{cause.line}.{value.line}"
