"""A change, before it is put into a review."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from cellc.contract.vocabulary import ApprovalArea, Grade, ReviewArea
from cellc.tools.review.leaves import Leaf
from cellc.tools.review.units import difference, shown_both

PRESENT = "present"
"""Value of what is there as a whole."""


Written: TypeAlias = tuple[Collection[str], Collection[str]]
"""Units in which values are written before and after."""


@dataclass(frozen=True, slots=True)
class Figures:
    """Values of a change in SI, with the unit of each there, and whether the difference is a share."""

    before: Leaf | None
    after: Leaf | None
    units: tuple[str, str]
    share: bool

    def texts(self, wanted: Written = ((), ())) -> tuple[str | None, str | None, str]:
        """Return values and difference as people read them, each in units that they wrote."""
        was, now = shown_both(self.before, self.after, self.units, wanted)
        unit, other = self.units
        is_one = unit == other
        delta = difference(self.before, self.after, unit, share=self.share, wanted=wanted[1]) if is_one else ""
        return was, now, delta


@dataclass(frozen=True, slots=True)
class Change:
    """A change, before similar ones are merged.

    Attributes:
        words: words and figures that it explains in other files.
        names: names of things added or removed with it.
        approval: that of its area where it is None.
        asks: areas of approval that are asked beside it and that of its area.
        figures: what its texts were made of, where units may be chosen.
        follows: it is of a kind that repeats others.
    """

    area: ReviewArea
    subject: str
    quantity: str
    before: str | None
    after: str | None
    grade: Grade
    delta: str = ""
    breaking: bool = False
    why: str = ""
    approval: ApprovalArea | None = None
    asks: tuple[ApprovalArea, ...] = ()
    figures: Figures | None = field(default=None, compare=False)
    follows: bool = field(default=False, compare=False)
    words: frozenset[str] = field(default=frozenset(), compare=False)
    names: frozenset[str] = field(default=frozenset(), compare=False)
    differing: frozenset[str] = field(default=frozenset(), compare=False)


def in_units(change: Change, wanted: Written) -> Change:
    """Return a change with its figures in the units in which the line was written that causes it."""
    figures = change.figures
    if figures is None or not any(wanted):
        return change
    was, now, delta = figures.texts(wanted)
    was, now = change.before if was is None else was, change.after if now is None else now
    return replace(change, before=was, after=now, delta=delta)
