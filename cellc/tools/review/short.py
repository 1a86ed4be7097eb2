"""A review for somebody in a hurry: what fails first, then each cause with the figures that count, in a screenful."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias

from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.diagnostics.wording import count
from cellc.contract.printing import Line, Style, Styled
from cellc.contract.review import Review, ReviewChange
from cellc.tools.review.groups import NAME_OF, Group, areas_of, groups_of
from cellc.tools.review.text import STYLES, outcomes, summed_up, values_of

MOST_LINES = 25
_WIDTH = 80
_FEW = 4
_NOTES = 2
_LONG = 40

_Lines: TypeAlias = list[Line]


def render_short(review: Review, most: int = MOST_LINES) -> Iterator[Line]:
    """Yield the lines of a review, at most so many, each at most as wide as a terminal."""
    head: _Lines = [summed_up(review), *_sides(review)]
    head += [f"note: {note}" for note in review.notes[:_NOTES]]
    new, foot = [*_findings(review)], [*_foot(review)]
    yield from (*head, *new)
    yield from _of_groups(groups_of(review), most - len(head) - len(new) - len(foot))
    yield from foot


def cut(text: str, width: int = _WIDTH) -> str:
    """Return a text that fits into a line of the terminal."""
    shown = escaped(text)
    return shown if len(shown) <= width else f"{shown[: width - 3]}..."


def _sides(review: Review) -> Iterator[Line]:
    for word, side in (("before", review.before), ("after", review.after)):
        yield f"{word:7} {side.name}, {side.configuration_id}"


def _findings(review: Review) -> Iterator[Line]:
    found = review.new_findings
    if not found:
        return
    yield (Styled(f"new findings: {len(found)}", Style.BOLD),)
    yield from (cut(f"  {each.severity}[{each.code}]: {each.message}") for each in found[:_FEW])
    if len(found) > _FEW:
        yield f"  and {len(found) - _FEW} more"


def _foot(review: Review) -> Iterator[Line]:
    if review.gone_findings:
        yield f"resolved findings: {len(review.gone_findings)}"
    differing = [each for each in review.rehearsals if each.before != each.after or each.passed_after is False]
    yield from (cut(f"rehearsal {outcomes(each)}") for each in differing[:_FEW])
    if len(differing) > _FEW:
        yield f"and {len(differing) - _FEW} more rehearsals"
    if review.gates:
        yield cut(f"gates to repeat: {', '.join(gate.code.value for gate in review.gates)}")
    if review.changes:
        yield (Styled("--all prints every value, finding and gate", Style.DIM),)


def _of_groups(groups: Sequence[Group], room: int) -> Iterator[Line]:
    """Yield each group with what there is room for: all of them have a line before one has many."""
    shown = groups if len(groups) <= room else groups[: room - 1]
    left = room - len(shown) - (len(shown) < len(groups))
    for number, group in enumerate(shown):
        share = max(left // (len(shown) - number), min(left, _FEW))
        inner = [*_inner(group, share)]
        left -= len(inner)
        grade = group.grade.value
        width = _WIDTH - len(grade) - 2
        yield (Styled(grade, STYLES[group.grade]), "  ", cut(group.fitting(width), width))
        yield from inner
    if len(shown) < len(groups):
        rest = groups[len(shown) :]
        yield f"and {count(len(rest), 'cause')} more with {count(sum(len(each.changes) for each in rest), 'change')}"


def _inner(group: Group, most: int) -> Iterator[Line]:
    """Yield the figures of a group, its worst changes, what is left, and who approves: what there is room for."""
    asked: _Lines = [(Styled(cut(f"  asks {group.asks}"), Style.DIM),)] if group.asks else []
    figures: _Lines = [(Styled(cut(f"  {'; '.join(group.figures)}"), Style.BOLD),)] if group.figures else []
    worst = _alike([change for change in group.changes if change.grade is group.grade or change.breaking])
    others = len(group.changes) - sum(map(len, worst.values()))
    room = min(_FEW, most - len(figures) - len(asked) - (others > 0))
    listed = [*worst] if len(worst) <= room else [*worst][: max(room - (others == 0), 0)]
    lines = [*figures, *(_line(text, worst[text]) for text in listed)]
    rest = [change for change in group.changes if not any(change in worst[text] for text in listed)]
    if rest:
        lines.append((Styled(cut(f"  {len(rest)} more: {areas_of(rest)}"), Style.DIM),))
    yield from (*lines, *asked)[: max(most, 0)]


def _alike(changes: Sequence[ReviewChange]) -> dict[str, list[ReviewChange]]:
    """Return changes by what is said of them: those of several subjects that changed by as much are one line."""
    alike: dict[str, list[ReviewChange]] = {}
    for change in changes:
        alike.setdefault(_said(change), []).append(change)
    return alike


def _said(change: ReviewChange) -> str:
    if change.quantity.startswith(NAME_OF):
        return f"breaks {change.why}" if change.breaking else "no consumer outside the cell knows it"
    breaks = ", breaks consumers" if change.breaking else ""
    values = change.delta if change.delta and len(values_of(change)) > _LONG else values_of(change)
    return f"{change.area}  {change.quantity} {values}{breaks}"


def _line(text: str, changes: Sequence[ReviewChange]) -> Line:
    subjects = [subject for change in changes for subject in change.subjects]
    more = f" and {len(subjects) - 1} more" if len(subjects) > 1 else ""
    is_name = changes[0].quantity.startswith(NAME_OF)
    return cut(f"  {text}" if is_name else f"  {text}: {subjects[0]}{more}")
