"""What follows for motion and data, though no value of it changed."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.diagnostics.wording import count
from cellc.contract.vocabulary import Grade, ReviewArea
from cellc.tools.review.change import Change
from cellc.tools.review.edges import edge_changes, offers_less
from cellc.tools.review.facts import Facts
from cellc.tools.review.geometry import moved_bases, moved_places
from cellc.tools.review.grading import ELSEWHERE, bases
from cellc.tools.review.replaced import MASS, Measured, measured_of
from cellc.tools.review.units import difference, shown


def effects(before: Facts, after: Facts) -> Iterator[Change]:
    """Yield what follows for motion and data, though no value of it changed."""
    for place in moved_places(before, after):
        sides = (shown(place.before, ""), shown(place.after, ""))
        yield Change(
            ReviewArea.MOTION,
            place.subject,
            place.quantity,
            *sides,
            Grade.REVIEW,
            difference(place.before, place.after, ""),
        )
    for base in moved_bases(before, after, bases(before) & bases(after)):
        yield Change(
            ReviewArea.FRAMES,
            base.subject,
            base.quantity,
            shown(base.before, ""),
            shown(base.after, ""),
            Grade.DANGEROUS,
            difference(base.before, base.after, ""),
            why=ELSEWHERE,
            approval="safety",
        )
    yield from map(_of_measured, measured_of(before, after))
    for name, missed in offers_less(before.contract, after.contract):
        why = f"subscribers outside of the cell that request {missed.requested} do not connect any more"
        sides, quantity = (missed.requested, missed.offered), f"offered {missed.policy}"
        yield Change(ReviewArea.QOS, name, quantity, *sides, Grade.REVIEW, breaking=True, why=why)
    for edge in edge_changes(before.contract, after.contract):
        taken = Grade.SAFE if edge.connects else Grade.DANGEROUS
        lost = "samples no longer arrive" if edge.before else "no sample arrives"
        why = "" if edge.connects else f"{lost} ({edge.after})"
        yield Change(
            ReviewArea.QOS, edge.subject, "edge", edge.before, edge.after, taken, breaking=not edge.connects, why=why
        )


_LINK = "link"


def _of_measured(each: Measured) -> Change:
    """Return what a model weighs or how far it reaches; a mass that a link lacks on a side has no difference."""
    unit, area = ("kg", ReviewArea.PAYLOAD) if each.quantity == MASS else ("m", ReviewArea.MODEL)
    is_whole = all(massive == shaped for massive, shaped in each.counted)
    was, now = (
        None if value is None else f"{shown(value, unit)}{'' if is_whole else f' ({having} of {count(of, _LINK)})'}"
        for value, (having, of) in zip((each.before, each.after), each.counted, strict=True)
    )
    delta = difference(each.before, each.after, unit) if is_whole else ""
    return Change(area, each.device, each.quantity, was, now, Grade.REVIEW, delta)
