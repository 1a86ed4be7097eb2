"""How ``cellc diff`` grades a change of a field: declared at the field itself, beside what it means.

A field carries it in its annotation, ``Annotated[Seconds | None, Graded(ReviewArea.TIME, rule=Rule.LOOSER)]``.
``cellc.tools.review.graded`` reads it; pydantic and dataclasses pass over it.
"""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from cellc.contract.vocabulary import ApprovalArea, ReviewArea


class Rule(Enum):
    """How a value that changed is graded; the texts are those of docs/review.md."""

    SAFE = "safe"
    REVIEW = "review"
    DANGEROUS = "dangerous"
    MORE = "dangerous where it grew or vanished, else safe"
    LESS = "dangerous where it shrank or vanished, else safe"
    LOOSER = "dangerous where it grew by more than 5 % or vanished, safe where it allows less, else review"
    FIGURE = "dangerous where it grew by more than 5 %, vanished or is zero, else review"
    HEAVIER = "dangerous where it is heavier by more than a tenth, else review"
    MEASURED = "dangerous where it grew by more than 5 % or vanished without a new revision, else review"
    FEWER = "dangerous where it shrank or vanished, else review"
    STRICTER = "safe where it is stated and allows less, else review"
    BACK = "dangerous where it is lower, else review"
    NAMED = "dangerous where it was stated and became UNKNOWN or vanished, else review"
    RESTATED = "dangerous where it was stated before, else review"
    MATRIX = "dangerous where it became incompatible, safe where it became OK, else review"
    PLACED = "dangerous for the base of an arm, of an obstacle, and without a new calibration; else review"
    COVERED = "dangerous where it no longer takes up all the room that it took, else review"
    APART = "dangerous where arms may meet in more room than before, else review"
    CLAIM = "dangerous where another claims it than before, else review"
    LOST = "dangerous where something of it is lost, else review"
    ADDED = "safe where nothing of it is lost, else review"
    KEPT = "dangerous where something of it is lost, else safe"
    COMPARED = "dangerous where something of it is compared nowhere any more, else review"
    LOAD = (
        "dangerous where it vanished, is beyond the rating, or changed by over a tenth of it unexplained; else review"
    )
    TOOL = "dangerous without a new calibration of a frame on it, else review"
    REPLACED = (
        "dangerous for an arm that ends elsewhere, and where what rests on the model before was left, else review"
    )
    CLOCK = "dangerous where it grew by more than 5 % or vanished and an age limit rests on it, else review"


class Graded(NamedTuple):
    """How a change of a field is graded; of a field of models, what they do not grade themselves.

    Args:
        quantity: what changed, as people read it: `bound of its offset`; the name of the field where it is empty.
        unit: SI unit of the value, for people: `m` is shown in mm, `rad` in degrees; `joint` is either,
            `effort` N or N m, `stiffness` and `damping` in the same way. A unit that the name of the field ends in is
            known.
        breaking: a consumer outside of the cell breaks.
        ordered: whether the order of a list says something.
        why: what the change means, beside the rule.
        each: what a key of a mapping names, such as `frame`; it is then the subject of the change.
        asks: areas of approval that are asked beside that of the area.
        share: whether how much it changed is shown as a share; of a length or a mass that people know, it is not.
    """

    area: ReviewArea
    quantity: str = ""
    rule: Rule = Rule.REVIEW
    unit: str = ""
    breaking: bool = False
    ordered: bool = True
    why: str = ""
    each: str = ""
    share: bool = True
    asks: tuple[ApprovalArea, ...] = ()


UNAVOIDED = "planning no longer avoids all the room that it avoided"
GRIPPED = "another part may be taken for the right one"
HARDER = "the fingers close harder, on a part as on a hand"
OTHER_LOAD = "the robot computes with another load"
OTHER_MASS = "force, payload and motion were chosen for a lighter part"
STALE = "older data may be used"
UNSEEN = "a failure is noticed later"
LONGER = "it moves on for longer before it stops"
FURTHER = "the joint may move further than people at the cell expect"
FASTER = "it may move faster than people at the cell expect"
PLANNED = "planned motion changes"
DEVIATES = "the joint may deviate further before it stops"
SECOND_CLIENT = "another client may command it"
"""What changes of several fields mean."""
