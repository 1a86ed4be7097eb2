"""A change, before it is put into a review."""

from __future__ import annotations

from dataclasses import dataclass, field

from cellc.contract.review import ApprovalArea
from cellc.contract.vocabulary import Grade, ReviewArea

PRESENT = "present"
"""Value of what is there as a whole."""


@dataclass(frozen=True, slots=True)
class Change:
    """A change, before similar ones are merged.

    Attributes:
        words: words and figures that it explains in other files.
        names: names of things added or removed with it.
        approval: that of its area where it is None.
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
    words: frozenset[str] = field(default=frozenset(), compare=False)
    names: frozenset[str] = field(default=frozenset(), compare=False)
    differing: frozenset[str] = field(default=frozenset(), compare=False)
