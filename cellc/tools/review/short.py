"""A review for somebody in a hurry: what fails first, then each cause with the figures that count, in a screenful."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.diagnostics.wording import count
from cellc.contract.printing import Line, Style, Styled
from cellc.contract.review import Review, ReviewChange, ReviewFinding
from cellc.contract.vocabulary import Grade
from cellc.tools.review.alike import alike, as_many_as_fit, fitting, line_of, rest_of
from cellc.tools.review.compare import UNCLASSIFIED
from cellc.tools.review.cutting import WIDTH, broken
from cellc.tools.review.groups import FINDING, Group, asked_of_all, broken_by, broken_shown, groups_of, why_of
from cellc.tools.review.restated import restated
from cellc.tools.review.text import STYLES, outcomes, summed_up

MOST_LINES = 25
_FEW = 4
_NOTES = 2
_SIDES = 2
_UNBOUNDED = 10_000

_Lines: TypeAlias = list[Line]


class _Folds(NamedTuple):
    """What gives way: lines of values first, then the reasons of each, then findings, then titles."""

    most_findings: int
    titles: bool
    """Whether titles are whole."""
    values: bool
    """Whether lines of values are whole."""
    whole: Mapping[frozenset[str], str]
    """What several subjects are together, such as all joints of an arm."""
    reasons: bool
    """Whether each line of values has its reason; else the dangers of a cause have theirs together."""
    every: bool = False
    """Whether what is of a lower grade than its heading is listed, too; else it is counted."""


def render_short(review: Review, most: int = MOST_LINES) -> Iterator[Line]:
    """Yield the lines of a review, at most so many, each at most as wide as a terminal.

    Where everything has no room, lines of values are shorter, then several causes that are not dangerous are one line.
    Why a change is dangerous, whose consumers it breaks and how nodes find each other is never left out.
    """
    groups = groups_of(review)
    whole = {
        frozenset(joints): f"all joints of {device}" for device, joints in review.after.joints.items() if joints[1:]
    }
    for folds in (
        _Folds(_FEW, titles=True, values=True, whole=whole, reasons=True, every=True),
        _Folds(_FEW, titles=True, values=True, whole=whole, reasons=True),
        _Folds(_FEW, titles=True, values=False, whole=whole, reasons=True),
        _Folds(_FEW, titles=True, values=False, whole=whole, reasons=False),
        _Folds(_NOTES, titles=True, values=False, whole=whole, reasons=False),
    ):
        lines = _rendered(review, groups, _UNBOUNDED, folds)
        if len(lines) <= most:
            yield from lines
            return
    for least in (_NOTES, 0):
        folds = _Folds(least, titles=False, values=False, whole=whole, reasons=False)
        lines = _rendered(review, groups, most, folds)
        if len([group for group in groups if group.grade is Grade.DANGEROUS]) <= _headings(lines):
            break
    yield from lines


def _first(text: str) -> Sequence[str]:
    """Return the first line, in two where it is too wide; the name of a side is never broken."""
    counts, semicolon, more = text.partition("; ")
    return [f"{counts};", f"  {more}"] if semicolon and len(text) > WIDTH else [text]


def _headings(lines: _Lines) -> int:
    """Return how many causes that are dangerous have a heading."""
    return sum(_plain(line).startswith(f"{Grade.DANGEROUS.value}  ") for line in lines)


def _rendered(review: Review, groups: Sequence[Group], most: int, folds: _Folds) -> _Lines:
    head: _Lines = [*_first(summed_up(review)), *_sides(review)]
    if not folds.most_findings and len(one := escaped("; ".join(map(_plain, _sides(review))))) <= WIDTH:
        head = [*head[:-_SIDES], one]
    head += [f"note: {note}" for note in review.notes[:_NOTES]]
    new, foot = [*_findings(review, folds.most_findings)], [*_foot(review)]
    broken_names = broken_by(review.changes)
    if not folds.titles:
        # Not every cause has room for who is asked, and for what breaks.
        asked = asked_of_all(groups)
        head += [(Styled(text, Style.DIM),) for text in broken(f"asks {asked}", "  ") if asked]
    body = [*_of_groups(groups, most - len(head) - len(new) - len(foot), folds)]
    if not _are_in(broken_names, body):
        head += broken(f"may break consumers of {broken_shown(broken_names)}", "  ")
        body = [*_of_groups(groups, most - len(head) - len(new) - len(foot), folds)]
    return [*head, *new, *body, *foot]


def _are_in(names: Sequence[str], lines: _Lines) -> bool:
    """Tell whether each name is in a line that says that its consumers may break."""
    said = " ".join(map(_plain, lines))
    return all(name.rpartition(" of ")[2] in said and said.count("may break") for name in names)


def _plain(line: Line) -> str:
    return line if isinstance(line, str) else "".join(each if isinstance(each, str) else each.text for each in line)


def _sides(review: Review) -> Iterator[Line]:
    for word, side in (("before", review.before), ("after", review.after)):
        yield f"{word:7} {side.name}, {side.configuration_id}"


def _findings(review: Review, most: int) -> Iterator[Line]:
    """Yield the new findings that fail; others stand below what they follow from."""
    found = [each for each in review.new_findings if each.severity == Severity.ERROR]
    if not found:
        return
    codes = Counter(f"{each.severity}[{each.code}]" for each in found)
    head = f"new findings: {len(found)}"
    told = head if most else as_many_as_fit(f"{head}, ", [*codes], counts=[*codes.values()])
    yield (Styled(told, Style.BOLD),)
    yield from _first_findings(found, most) if most else ()


def _first_findings(found: Sequence[ReviewFinding], most: int) -> Iterator[str]:
    """Yield the first findings, each once: the same is found in several places, such as both ends of a topic."""
    told = [*dict.fromkeys(f"  new {each.severity}[{each.code}]: {each.message}" for each in found)]
    for text in told[:most]:
        yield from broken(text, "    ")
    if len(told) > most:
        yield f"  and {len(told) - most} more new findings"


def _foot(review: Review) -> Iterator[Line]:
    left = [each for each in review.new_findings if each.severity != Severity.ERROR and each.cause is None]
    yield from _first_findings(left, _NOTES)
    if review.gone_findings:
        codes = Counter(f"{each.severity}[{each.code}]" for each in review.gone_findings)
        told = [f"{code}{f' {number} times' if number > 1 else ''}" for code, number in codes.items()]
        head = f"resolved findings: {len(review.gone_findings)}, "
        yield as_many_as_fit(head, told, counts=[*codes.values()])
    differing = [each for each in review.rehearsals if each.before != each.after or each.passed_after is False]
    yield from (line for each in differing[:_FEW] for line in broken(f"rehearsal {outcomes(each)}", "  "))
    if len(differing) > _FEW:
        yield f"and {len(differing) - _FEW} more rehearsals"
    if review.gates:
        yield f"gates to repeat: {', '.join(gate.code.value for gate in review.gates)}"
    if review.changes:
        yield (Styled("--all prints every value, finding and gate", Style.DIM),)


def _of_groups(groups: Sequence[Group], room: int, folds: _Folds) -> Iterator[Line]:
    """Yield each group with what there is room for: what must be said of each comes before what else one has."""
    titles = [_title(group, whole=True) for group in groups]
    musts = [[*_must(group, folds), *_because(group, folds)] for group in groups]
    if sum(map(len, (*titles, *musts))) > room:
        # What follows gives way before what a heading says.
        titles = [_title(group, whole=folds.titles) for group in groups]
    needed = [len(title) + len(must) for title, must in zip(titles, musts, strict=True)]
    shown = _shown(groups, needed, room)
    rest = _rest_of([group for number, group in enumerate(groups) if number not in shown])
    left = room - sum(len(titles[number]) + len(musts[number]) for number in shown) - len(rest)
    wanted = [len([*_inner(groups[number], _UNBOUNDED, folds)]) - len(musts[number]) for number in shown]
    for place, number in enumerate(shown):
        # What those behind it do not need is there for it.
        fair = left // (len(shown) - place)
        spare = sum(max(fair - other, 0) for other in wanted[place + 1 :])
        share = max(fair + spare, min(left, _FEW), 0)
        inner = [*_inner(groups[number], share + len(musts[number]), folds)]
        left -= max(len(inner) - len(musts[number]), 0)
        yield from titles[number]
        yield from inner
    yield from rest


def _rest_of(groups: Sequence[Group]) -> Sequence[str]:
    """Return groups that have no heading: why each is dangerous, how nodes find each other, and the names of others."""
    dangers = [group for group in groups if group.grade is Grade.DANGEROUS]
    finding = [group for group in groups if group not in dangers and group.finds]
    others = [group for group in groups if group not in (*dangers, *finding)]
    lines = list[str]()
    if dangers:
        whys = [(*(text.replace("`", "") for text in group.unmeasured), *group.whys) for group in dangers]
        told = [f"{group.name}: {'; '.join(why)}" for group, why in zip(dangers, whys, strict=True)]
        lines += broken(f"{Grade.DANGEROUS.value}  also {'; '.join(told)}", "  ")
    if finding:
        lines += broken(f"also {'; '.join(group.fitting(WIDTH) for group in finding)}", "  ")
    if others:
        changes = count(sum(len(group.changes) for group in others), "change")
        head = f"and {count(len(others), 'cause')} more with {changes}: "
        lines.append(as_many_as_fit(head, [group.name for group in others]))
    return lines


def _shown(groups: Sequence[Group], needed: Sequence[int], room: int) -> list[int]:
    """Return the groups that have a heading: of those that are no danger, the last give way first."""
    shown = [*range(len(groups))]
    optional = [number for number in shown if groups[number].grade is not Grade.DANGEROUS and not groups[number].finds]
    for number in (*reversed(optional), *reversed(shown)):
        rest = _rest_of([group for each, group in enumerate(groups) if each not in shown])
        if sum(needed[each] for each in shown) + len(rest) <= room or len(shown) == 1:
            break
        if number in shown:
            shown.remove(number)
    return shown


def _must(group: Group, folds: _Folds) -> _Lines:
    """Return what leads a group, however many there are: what was not measured, how nodes find each other."""
    lines: _Lines = [line for text in group.unmeasured for line in broken(f"  {text.replace('`', '')}", "    ")]
    cause = group.cause
    if cause is not None and len(cause.values) > 1:
        found = [value for value in cause.values if value.line.startswith(FINDING)]
        title = " ".join(map(_plain, _title(group, whole=folds.titles)))
        told = [f"{value.line}: {value.before or 'not stated'} -> {value.after or 'not stated'}" for value in found]
        lines += [line for text in told if text not in title for line in broken(f"  {text}", "    ")]
    return lines


def _because(group: Group, folds: _Folds) -> _Lines:
    """Return why a group is dangerous, where not each of its lines says so."""
    return [] if folds.reasons or not group.whys else [*broken(f"  because {'; '.join(group.whys)}", "    ")]


def _meant(again: Sequence[ReviewChange], folds: _Folds) -> _Lines:
    """Return what changes mean that only say their heading again; of dangers that is said where no line says it."""
    told = [why_of(change) for change in again if change.grade is Grade.REVIEW and folds.reasons]
    whys = [*dict.fromkeys(filter(None, told))]
    return [*broken(f"  because {'; '.join(whys)}", "    ")] if whys else []


def _title(group: Group, *, whole: bool) -> _Lines:
    grade = group.grade.value
    start = f"{grade}  "
    text = group.title if whole else f"{group.fitting(WIDTH - len(start))}"
    first, *more = broken(start + text, "  ")
    return [(Styled(grade, STYLES[group.grade]), first[len(grade) :]), *more]


def _inner(group: Group, most: int, folds: _Folds) -> Iterator[Line]:
    """Yield the figures of a group, its worst changes, what is left, and who approves: what there is room for."""
    is_listed = not folds.titles  # who approves is listed for all groups together
    title = " ".join(_plain(line).strip() for line in _title(group, whole=folds.titles))
    again = restated(group.listed, group, title)
    changes = sorted((change for change in group.listed if change not in again), key=_is_of_lines)
    asked: _Lines = (
        [(Styled(text, Style.DIM),) for text in broken(f"  asks {group.asks}", "    ")]
        if group.asks and not is_listed
        else []
    )
    lead, reason = _must(group, folds), [*_because(group, folds), *_meant(again, folds)]
    must = len(lead) + len(reason)
    found = [*_first_findings(group.findings, min(folds.most_findings, _NOTES))]
    # A danger is seen before figures are.
    lines_left = max(most - must - len(found) - len(asked) - bool(changes) - 1, 1)
    figures: _Lines = [(Styled(line, Style.BOLD),) for line in _first_figures(group.figures, lines_left)]
    figures += found
    kept = broken(f"  {group.kept}", "    ")
    whole = must + len(figures) + len(kept) + len(asked) < most
    if kept:
        figures += kept if whole else broken(as_many_as_fit("  ", group.kept.split("; "), "; "), "    ")
    worst = _worst(changes, group, folds)
    others = len(changes) - sum(map(len, worst.values()))
    room = min(_FEW, most - must - len(figures) - len(asked) - (others > 0))
    listed = [*worst] if len(worst) <= room else [*worst][: max(room - (others == 0), 0)]
    reasons = set[str]()
    blocks = [_values(line_of(text, worst[text], folds.whole), worst[text], folds, reasons) for text in listed]
    room = max(most - len(asked) - must, 0)
    for number in range(len(blocks), -1, -1):
        # A change is whole or not there.
        rest = [change for change in changes if not any(change in worst[text] for text in listed[:number])]
        lines: _Lines = [*figures, *(line for block in blocks[:number] for line in block)]
        if rest:
            lines += [(Styled(line, Style.DIM),) for line in rest_of(rest, group, folds.whole, is_whole=not number)]
        if len(lines) <= room:
            break
    whole_lines = [*lead, *lines[:room], *reason, *_unsaid(group, [*lines, *reason])]
    yield from (*_with_asks(whole_lines, group, is_listed=is_listed), *asked)[: max(most, 0)]


def _worst(changes: Sequence[ReviewChange], group: Group, folds: _Folds) -> dict[str, list[ReviewChange]]:
    """Return the changes of the grade of a heading, and where there is room the others behind them, by their lines."""
    worst = alike([change for change in changes if change.grade is group.grade or change.breaking])
    lower = alike([change for change in changes if change.grade is not group.grade and not change.breaking])
    return {**worst, **lower} if folds.every and worst.keys().isdisjoint(lower) else worst


def _unsaid(group: Group, lines: _Lines) -> Sequence[str]:
    """Return why a group is dangerous where no line says so: what changed is in its heading, or one of many."""
    said = " ".join(_plain(line).strip() for line in lines)
    whys = [why for why in group.whys if escaped(why) not in said]
    return broken(f"  because {'; '.join(whys)}", "    ") if whys else []


def _with_asks(lines: _Lines, group: Group, *, is_listed: bool) -> _Lines:
    """Return lines with the areas that are asked behind the last of them, where it has room for that."""
    asks = f"; asks {', '.join(part.partition(' (')[0] for part in group.asks.split(', '))}" if group.asks else ""
    if not is_listed or not asks or not lines:
        return lines
    last = lines[-1]
    text = _plain(last)
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


def _values(line: str, changes: Sequence[ReviewChange], folds: _Folds, said: set[str]) -> list[str]:
    """Return a change with what it means where there is room for that; how much it changed is never cut.

    Args:
        said: what changes above it mean; what this one means is added.
    """
    change = changes[0]
    why = "" if change.why in said else why_of(change)
    said.add(change.why)
    is_told = folds.reasons and change.grade is not Grade.SAFE and not change.breaking
    reason = broken(f"    because {why}", "      ") if why and is_told else []
    return [*(broken(line, "    ") if folds.values else fitting(line, changes, folds.whole)), *reason]
