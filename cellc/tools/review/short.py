"""A review for somebody in a hurry: what fails first, then each cause with the figures that count, in a screenful."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.diagnostics.wording import count
from cellc.contract.printing import Line, Style, Styled
from cellc.contract.review import Review, ReviewChange, ReviewFinding
from cellc.contract.vocabulary import Grade
from cellc.tools.review.carried import ENDS_ELSEWHERE
from cellc.tools.review.compare import UNCLASSIFIED, WHOLE
from cellc.tools.review.cutting import WIDTH, broken, cut
from cellc.tools.review.grading import UNMEASURED
from cellc.tools.review.groups import NAME_OF, Group, areas_of, asked_of, broken_by, groups_of, quantities_of, values_of
from cellc.tools.review.replaced import PAIRS
from cellc.tools.review.text import STYLES, outcomes, summed_up

MOST_LINES = 25
_FEW = 4
_NOTES = 2
_FEW_PAIRS = 2
_LONG = 40
_MOSTLY = 60
_UNBOUNDED = 10_000

_Lines: TypeAlias = list[Line]
_Fold: TypeAlias = Callable[[str, str], list[str]]
"""What makes lines of a text, and with what those after the first begin."""


class _Folds(NamedTuple):
    findings: _Fold
    titles: _Fold
    values: _Fold
    whole: Mapping[frozenset[str], str]
    """What several subjects are together, such as all joints of an arm."""
    reasons: bool
    """Whether each danger has its reason, where a line of values is cut."""


def render_short(review: Review, most: int = MOST_LINES) -> Iterator[Line]:
    """Yield the lines of a review, at most so many, each at most as wide as a terminal.

    Long ones are broken where everything has room then; else values are cut first, then findings, then titles.
    """
    groups = groups_of(review)
    whole = {
        frozenset(joints): f"all joints of {device}" for device, joints in review.after.joints.items() if joints[1:]
    }
    for folds in (
        _Folds(broken, broken, broken, whole, reasons=True),
        _Folds(broken, broken, _cut, whole, reasons=True),
        _Folds(broken, broken, _cut, whole, reasons=False),
        _Folds(_cut, broken, _cut, whole, reasons=False),
    ):
        lines = _rendered(review, groups, _UNBOUNDED, folds)
        if len(lines) <= most:
            yield from lines
            return
    yield from _rendered(review, groups, most, _Folds(_cut, _cut, _cut, whole, reasons=False))


def _rendered(review: Review, groups: Sequence[Group], most: int, folds: _Folds) -> _Lines:
    head: _Lines = [summed_up(review), *_sides(review)]
    head += [f"note: {note}" for note in review.notes[:_NOTES]]
    if folds.titles is _cut:
        # Not every cause has room for who is asked, and for what breaks.
        asked = asked_of(review.changes)
        head += [(Styled(text, Style.DIM),) for text in broken(f"asks {asked}", "  ") if asked]
        head += (
            broken(f"may break consumers of {_first_of(names)}", "  ") if (names := broken_by(review.changes)) else []
        )
    new, foot = [*_findings(review, folds.findings)], [*_foot(review)]
    return [*head, *new, *_of_groups(groups, most - len(head) - len(new) - len(foot), folds), *foot]


def _first_of(names: Sequence[str]) -> str:
    return ", ".join(names[:_FEW]) + (f" and {len(names) - _FEW} more" if len(names) > _FEW else "")


def _cut(text: str, _: str) -> list[str]:
    return [cut(text)]


def _sides(review: Review) -> Iterator[Line]:
    for word, side in (("before", review.before), ("after", review.after)):
        yield f"{word:7} {side.name}, {side.configuration_id}"


def _findings(review: Review, fold: _Fold) -> Iterator[Line]:
    """Yield the new findings that fail; others stand below what they follow from."""
    found = [each for each in review.new_findings if each.severity == Severity.ERROR]
    if not found:
        return
    yield (Styled(f"new findings: {len(found)}", Style.BOLD),)
    yield from _first_findings(found, fold)


def _first_findings(found: Sequence[ReviewFinding], fold: _Fold, most: int = _FEW) -> Iterator[str]:
    for each in found[:most]:
        yield from fold(f"  new {each.severity}[{each.code}]: {each.message}", "    ")
    if len(found) > most:
        yield f"  and {len(found) - most} more new findings"


def _foot(review: Review) -> Iterator[Line]:
    left = [each for each in review.new_findings if each.severity != Severity.ERROR and each.cause is None]
    yield from _first_findings(left, _cut, _NOTES)
    if review.gone_findings:
        codes = Counter(f"{each.severity}[{each.code}]" for each in review.gone_findings)
        told = ", ".join(f"{code}{f' {number} times' if number > 1 else ''}" for code, number in codes.items())
        yield cut(f"resolved findings: {len(review.gone_findings)}, {told}")
    differing = [each for each in review.rehearsals if each.before != each.after or each.passed_after is False]
    yield from (cut(f"rehearsal {outcomes(each)}") for each in differing[:_FEW])
    if len(differing) > _FEW:
        yield f"and {len(differing) - _FEW} more rehearsals"
    if review.gates:
        yield cut(f"gates to repeat: {', '.join(gate.code.value for gate in review.gates)}")
    if review.changes:
        yield (Styled("--all prints every value, finding and gate", Style.DIM),)


def _of_groups(groups: Sequence[Group], room: int, folds: _Folds) -> Iterator[Line]:
    """Yield each group with what there is room for: all of them have a line before one has many."""
    shown = groups if len(groups) <= room else groups[: room - 1]
    titles = [_title(group, broken) for group in shown]
    if sum(map(len, titles)) + len(shown) > room:
        # What follows gives way before what a heading says.
        titles = [_title(group, folds.titles) for group in shown]
    left = room - sum(map(len, titles)) - (len(shown) < len(groups))
    is_listed = folds.titles is _cut
    wanted = [len([*_inner(group, _UNBOUNDED, folds, is_listed=is_listed)]) for group in shown]
    for number, (group, title) in enumerate(zip(shown, titles, strict=True)):
        # What those behind it do not need is there for it.
        fair = left // (len(shown) - number)
        spare = sum(max(fair - other, 0) for other in wanted[number + 1 :])
        share = max(fair + spare, min(left, _FEW))
        inner = [*_inner(group, share, folds, is_listed=is_listed)]
        left -= len(inner)
        yield from title
        yield from inner
    if len(shown) < len(groups):
        rest = groups[len(shown) :]
        changes = sum(len(group.changes) for group in rest)
        yield f"and {count(len(rest), 'cause')} more with {count(changes, 'change')}"


def _title(group: Group, fold: _Fold) -> _Lines:
    grade = group.grade.value
    start = f"{grade}  "
    text = group.title if fold is broken else f"{group.fitting(WIDTH - len(start))}"
    first, *more = fold(start + text, "  ")
    return [(Styled(grade, STYLES[group.grade]), first[len(grade) :]), *more]


def _inner(group: Group, most: int, folds: _Folds, *, is_listed: bool) -> Iterator[Line]:
    """Yield the figures of a group, its worst changes, what is left, and who approves: what there is room for.

    Args:
        is_listed: who approves is listed for all groups together.
    """
    changes = sorted(group.listed, key=_is_of_lines)
    asked: _Lines = (
        [(Styled(text, Style.DIM),) for text in broken(f"  asks {group.asks}", "    ")]
        if group.asks and not is_listed
        else []
    )
    figures: _Lines = [line for text in group.unmeasured for line in broken(f"  {text.replace('`', '')}", "    ")]
    found = [*_first_findings(group.findings, folds.findings, _NOTES)]
    dangers = len({_said(change) for change in changes if change.grade is Grade.DANGEROUS})
    # A danger is seen before figures are.
    lines_left = max(most - len(figures) - len(found) - len(asked) - min(dangers, _FEW) - 1, 1)
    figures += [(Styled(line, Style.BOLD),) for line in _first_figures(group.figures, lines_left)]
    figures += found
    kept = broken(f"  {group.kept}", "    ")
    figures += kept if len(figures) + len(kept) + len(asked) < most else [cut(f"  {group.kept}")][: len(kept)]
    worst = _alike([change for change in changes if change.grade is group.grade or change.breaking])
    others = len(changes) - sum(map(len, worst.values()))
    room = min(_FEW, most - len(figures) - len(asked) - (others > 0))
    listed = [*worst] if len(worst) <= room else [*worst][: max(room - (others == 0), 0)]
    reasons = set[str]()
    lines = [*figures]
    for text in listed:
        lines += _values(_line(text, worst[text], folds.whole), worst[text], folds, reasons)
        reasons.add(worst[text][0].why)
    rest = [change for change in changes if not any(change in worst[text] for text in listed)]
    if rest:
        lines.append((Styled(cut(_rest(rest, group, folds.whole, is_whole=not listed)), Style.DIM),))
    room = max(most - len(asked), 0)
    if len(lines) > room > 0 and changes:
        lines = [*lines[: room - 1], (Styled(cut(f"  {_listed(changes, group)}"), Style.DIM),)]
    yield from (*_with_asks(lines[:room], group, is_listed=is_listed), *asked)[: max(most, 0)]


def _with_asks(lines: _Lines, group: Group, *, is_listed: bool) -> _Lines:
    """Return lines with the areas that are asked behind the last of them, where it has room for that."""
    asks = f"; asks {', '.join(part.partition(' (')[0] for part in group.asks.split(', '))}" if group.asks else ""
    if not is_listed or not asks or not lines:
        return lines
    last = lines[-1]
    text = last if isinstance(last, str) else "".join(each if isinstance(each, str) else each.text for each in last)
    return (
        [*lines[:-1], (last, asks) if isinstance(last, str) else (*last, asks)] if len(text + asks) <= WIDTH else lines
    )


def _first_figures(figures: Sequence[str], most: int) -> list[str]:
    """Return as many figures as so many lines have room for, none of them cut."""
    for kept in range(len(figures), 0, -1):
        more = f"; and {len(figures) - kept} more" if kept < len(figures) else ""
        lines = broken(f"  {'; '.join(figures[:kept])}{more}", "    ")
        if len(lines) <= most or kept == 1:
            return lines
    return []


def _is_of_lines(change: ReviewChange) -> bool:
    """Tell whether a change is that of a file: what its values say is read first."""
    return change.quantity.endswith(UNCLASSIFIED) or change.quantity.startswith("file ")


def _values(line: str, changes: Sequence[ReviewChange], folds: _Folds, said: Collection[str]) -> list[str]:
    """Return a change with what it means where there is room for that; how much it changed is never cut.

    Args:
        said: what changes above it mean.
    """
    change, fold = changes[0], folds.values
    why = (
        ""
        if change.why in said or change.why.endswith((UNMEASURED, ENDS_ELSEWHERE))
        else change.why.partition(", before ")[0].replace("`", "")
    )
    is_told = folds.reasons and change.grade is not Grade.SAFE and not change.breaking
    reason = fold(f"    because {why}", "      ") if why and is_told else []
    if fold is broken:
        return [*fold(line, "    "), *reason]
    return [_fitting(line, changes, folds.whole), *reason]


def _fitting(line: str, changes: Sequence[ReviewChange], whole: Mapping[frozenset[str], str]) -> str:
    """Return a change in one line: whole, else by how much, else with its values or its subject, what is shorter."""
    change = changes[0]
    head = f"{change.area}  {change.quantity}"
    is_name = change.quantity.startswith(NAME_OF)
    sized = [_line(f"{head} {change.delta}", changes, whole)] if change.delta and not is_name else []
    fitting = next((escaped(each) for each in (line, *sized) if len(escaped(each)) <= WIDTH), None)
    if fitting is not None:
        return fitting
    return cut(line if is_name or len(line.partition(": ")[0]) <= _MOSTLY else _line(head, changes, whole))


def _rest(rest: Sequence[ReviewChange], group: Group, whole: Mapping[frozenset[str], str], *, is_whole: bool) -> str:
    """Return what there is no room for: one change itself, of more those of each area, or of one area of each kind."""
    if len(rest) == 1:
        return _line(_said(rest[0]), rest, whole)
    return f"  {_listed(rest, group, count(len(rest), 'change') if is_whole else f'{len(rest)} more')}"


def _listed(changes: Sequence[ReviewChange], group: Group, head: str = "") -> str:
    """Return how many changes there are of each area, or of one area of each kind, as many as a line has room for."""
    head = head or count(len(changes), "change")
    kinds = (areas_of(changes) if group.cause is not None else quantities_of(changes)).split(", ")
    lines = (
        f"{head}: {', '.join(kinds[:kept])}" + (f" and {len(kinds) - kept} more" if kept < len(kinds) else "")
        for kept in range(len(kinds), 0, -1)
    )
    return next((line for line in lines if len(line) <= WIDTH - 2), f"{head}: {kinds[0]}")


def _alike(changes: Sequence[ReviewChange]) -> dict[str, list[ReviewChange]]:
    """Return changes by what is said of them: those of several subjects that changed by as much are one line."""
    alike: dict[str, list[ReviewChange]] = {}
    shares = Counter((change.area, change.quantity, change.delta) for change in changes if change.delta.endswith("%"))
    for change in changes:
        is_share = shares[change.area, change.quantity, change.delta] > 1 and not change.breaking
        said = f"{change.area}  {change.quantity} {change.delta}" if is_share else _said(change)
        alike.setdefault(said, []).append(change)
    return alike


def _said(change: ReviewChange) -> str:
    if change.quantity.startswith(NAME_OF):
        return f"may break {change.why}" if change.breaking else "no consumer outside the cell knows it"
    breaks = " (may break consumers outside the cell)" if change.breaking else ""
    if change.quantity == "frame removed":
        return f"{change.area}  {change.quantity} (its parent was {change.before}){breaks}"
    values = change.delta if change.delta and len(values_of(change)) > _LONG else values_of(change)
    return f"{change.area}  {change.quantity} {values}".rstrip() + breaks


def _line(text: str, changes: Sequence[ReviewChange], whole: Mapping[frozenset[str], str]) -> str:
    subjects = [subject for change in changes for subject in change.subjects]
    more = f" and {len(subjects) - 1} more" if len(subjects) > 1 else ""
    if changes[0].quantity in PAIRS:
        first, rest = ", ".join(subjects[:_FEW_PAIRS]), ", ..." * (len(subjects) > _FEW_PAIRS)
        return f"  {changes[0].area}  {count(len(subjects), 'pair')} {changes[0].quantity}: {first}{rest}"
    is_named = changes[0].quantity.startswith(NAME_OF) or subjects == [WHOLE]
    named = whole.get(frozenset(subjects), f"{subjects[0]}{more}")
    return f"  {text}" if is_named else f"  {text}: {named}"
