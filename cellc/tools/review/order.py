"""In which order changes are read: the worst first, then what stops, what reaches farther, what changed most."""

from __future__ import annotations

import math
import re

from cellc.contract.review import ReviewChange
from cellc.contract.vocabulary import Grade, ReviewArea
from cellc.tools.review.rules import LATER

_ANY = 3
_WEIGHTS = (
    (0, re.compile(r"watchdog|\bstop|\bcap\b|^model$")),
    (
        1,
        re.compile(
            r"^approver |^interface added|\breach|^base in|lower position|upper position|collision shapes (?!added)|"
            "^parent$|pose in its parent"
        ),
    ),
    (2, re.compile(r"payload|\bload\b|grip force")),
    (4, re.compile(r"\bacceleration|\bjerk|deceleration")),
    (5, re.compile("tolerance|timeout")),
    (6, re.compile("gain|stiffness|damping")),
)
"""What stops is read first; then who answers and how far things get, what they carry, and how fast; then tolerances."""
MANIFOLD = 2
"""Places by which a figure goes ahead that is at least doubled or halved."""


def order_of(change: ReviewChange) -> tuple[int, int, bool, float, bool, int, bool, str, tuple[str, ...]]:
    """Return the place of a change: by grade, by what it means to people, by what safety approves, by size, by area."""
    areas, grades = tuple(ReviewArea), tuple(Grade)
    is_later = change.quantity.endswith(LATER)
    other = 0 if change.area is ReviewArea.SAFETY else _ANY
    weight = next((place for place, words in _WEIGHTS if words.search(change.quantity)), other)
    doublings = _doublings(change.delta)
    return (
        -grades.index(change.grade),
        max(weight - MANIFOLD, 0) if is_manifold(change) else weight,
        change.approval != "safety",
        -doublings,
        not change.delta.startswith("loses"),
        areas.index(change.area),
        is_later,
        change.quantity,
        change.subjects,
    )


def is_manifold(change: ReviewChange) -> bool:
    """Tell whether a figure was at least doubled or halved."""
    return _doublings(change.delta) >= 1.0


def _doublings(delta: str) -> float:
    """Return how often a figure was doubled or halved, by its difference in percent; 0 where that is not stated."""
    share = re.match(r"([-+]\d+(?:\.\d+)?) ?%", delta)
    factor = 0.0 if share is None else 1.0 + float(share[1]) / 100.0
    return abs(math.log2(factor)) if factor > 0.0 else 0.0
