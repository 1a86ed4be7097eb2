"""What a short review says of changes: those that are alike in one line, none cut within what it says."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.diagnostics.wording import count
from cellc.contract.review import ReviewChange
from cellc.tools.review.compare import WHOLE
from cellc.tools.review.counts import areas_of, quantities_of
from cellc.tools.review.cutting import WIDTH, broken
from cellc.tools.review.groups import NAME_OF, Group, values_of
from cellc.tools.review.replaced import PAIRS

_LONG = 40
_SUBJECTS = 3
"""Subjects of a change that are all named."""
_LINES = 3
"""Lines that a change may take that breaks no consumer."""


def as_many_as_fit(head: str, items: Sequence[str], joint: str = ", ", counts: Sequence[int] = ()) -> str:
    """Return as many items as a line has room for, the first at least and none of them cut, with how many more.

    Args:
        counts: for how many each item counts; one where it is empty.
    """
    each = counts or [1] * len(items)
    for kept in range(len(items), 0, -1):
        more = f" and {sum(each[kept:])} more" if kept < len(items) else ""
        line = escaped(head + joint.join(items[:kept]) + more)
        if len(line) <= WIDTH or kept == 1:
            return line
    return head


def fitting(line: str, changes: Sequence[ReviewChange], whole: Mapping[frozenset[str], str]) -> list[str]:
    """Return a change in one line where that says its values or by how much; else broken, for none is cut."""
    change = changes[0]
    is_name = change.quantity.startswith(NAME_OF)
    sized = [line_of(f"{change.area}  {change.quantity} {change.delta}", changes, whole)] if change.delta else []
    lines = (line, *([] if is_name else sized))
    found = next((escaped(each) for each in lines if len(escaped(each)) <= WIDTH), None)
    if found is not None:
        return [found]
    is_long = not change.breaking and len(escaped(line)) > _LINES * WIDTH
    return broken(line_of(f"{change.area}  {change.quantity}", changes, whole) if is_long else line, "    ")


def rest_of(
    rest: Sequence[ReviewChange], group: Group, whole: Mapping[frozenset[str], str], *, is_whole: bool
) -> Sequence[str]:
    """Return what there is no room for: one change itself, of more those of each area, or of one area of each kind."""
    if len(rest) == 1:
        return fitting(line_of(_said(rest[0]), rest, whole), rest, whole)
    return [f"  {_listed(rest, group, count(len(rest), 'change') if is_whole else f'{len(rest)} more')}"]


def _listed(changes: Sequence[ReviewChange], group: Group, head: str = "") -> str:
    """Return how many changes there are of each area, or of one area of each kind, as many as a line has room for."""
    head = head or count(len(changes), "change")
    kinds = (areas_of(changes) if group.cause is not None else quantities_of(changes)).split(", ")
    lines = (
        f"{head}: {', '.join(kinds[:kept])}" + (f" and {len(kinds) - kept} more" if kept < len(kinds) else "")
        for kept in range(len(kinds), 0, -1)
    )
    return next((line for line in lines if len(line) <= WIDTH - 2), f"{head}: {kinds[0]}")


def alike(changes: Sequence[ReviewChange]) -> dict[str, list[ReviewChange]]:
    """Return changes by what is said of them: those of several subjects that changed by as much are one line."""
    alike: dict[str, list[ReviewChange]] = {}
    news = Counter(_newly(change) for change in changes if _newly(change))
    shares = Counter((change.area, change.quantity, change.delta) for change in changes if change.delta.endswith("%"))
    for change in changes:
        is_share = shares[change.area, change.quantity, change.delta] > 1 and not change.breaking
        said = f"{change.area}  {change.quantity} {change.delta}" if is_share else _said(change)
        if news[_newly(change)] > 1:
            said = _newly(change)
        alike.setdefault(said, []).append(change)
    return alike


def _newly(change: ReviewChange) -> str:
    """Return what is said of several values of a kind that are stated where none was; nothing of another change."""
    kind, _, of = change.quantity.partition(" ")
    is_new = change.before is None and of and not change.breaking and not change.quantity.endswith(_WHOLE)
    return f"{change.area}  {kind}s stated that were not" if is_new and kind in _KINDS else ""


_KINDS, _WHOLE = ("parameter", "variable", "image"), ("added", "removed")
"""Kinds of values of which there are many of one thing; and how the quantity ends of what comes or goes as a whole."""


def _said(change: ReviewChange) -> str:
    if change.quantity.startswith(NAME_OF):
        return f"may break {change.why}" if change.breaking else "no consumer outside the cell knows it"
    breaks = " (may break consumers outside the cell)" if change.breaking else ""
    if change.quantity == "frame removed":
        return f"{change.area}  {change.quantity} (its parent was {change.before}){breaks}"
    values = change.delta if change.delta and len(values_of(change)) > _LONG else values_of(change)
    return f"{change.area}  {change.quantity} {values}".rstrip() + breaks


def line_of(text: str, changes: Sequence[ReviewChange], whole: Mapping[frozenset[str], str]) -> str:
    subjects = [subject for change in changes for subject in change.subjects]
    if changes[0].quantity in PAIRS:
        return as_many_as_fit(f"  {changes[0].area}  {count(len(subjects), 'pair')} {changes[0].quantity}: ", subjects)
    is_named = changes[0].quantity.startswith(NAME_OF) or subjects == [WHOLE]
    # What its reason names is not among those that are counted.
    subjects.sort(key=lambda subject: f"`{subject}`" not in changes[0].why)
    kept = len(subjects) if len(subjects) <= _SUBJECTS else 1
    more = f" and {len(subjects) - kept} more" if len(subjects) > kept else ""
    named = whole.get(frozenset(subjects), f"{', '.join(subjects[:kept])}{more}")
    return f"  {text}" if is_named else f"  {text}: {named}"
