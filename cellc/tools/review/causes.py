"""Which lines of a spec cause which changes: each is tried alone, on the state before, or undone in that after."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from cellc.compiler.pipeline import check_document
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Severity, YamlPath
from cellc.contract.review import ReviewCause, ReviewFinding, ReviewValue
from cellc.contract.vocabulary import Grade, ReviewArea
from cellc.tools.review.acts import MEASURED, Cause, alike, described, is_model, shortened, texts_of
from cellc.tools.review.change import Change
from cellc.tools.review.compare import UNCLASSIFIED, reported
from cellc.tools.review.facts import Facts
from cellc.tools.review.findings import more, said_of
from cellc.tools.review.sides import Package, SideError, package_of
from cellc.tools.review.spec_edits import SpecEdit, undone, with_edits
from cellc.tools.review.titles import WHOLE_SPEC

_Changes: TypeAlias = Mapping[tuple[str, str], Change]
"""Changes by subject and quantity."""


_JOINT = "joint"
Brought: TypeAlias = frozenset[tuple[str, str]]
"""What findings say that a cause brings."""


@dataclass(frozen=True, slots=True)
class State:
    """A spec with the facts of the package that is made of it."""

    document: SourceDocument
    facts: Facts
    findings: tuple[ReviewFinding, ...] = ()

    @property
    def errors(self) -> frozenset[str]:
        """Codes of errors that it has."""
        return frozenset(found.code for found in self.findings if found.severity == Severity.ERROR)


@dataclass(frozen=True, slots=True)
class _Trial:
    """What a cause changes by itself.

    It is not valid where the spec has errors that neither side has, both with it alone and with all but it.
    """

    changes: _Changes
    valid: bool
    brought: Brought = frozenset()


def attributed(
    changes: Sequence[Change], causes: Sequence[Cause], before: State, after: State
) -> tuple[tuple[Cause, ...], list[tuple[int | None, Change]], tuple[Brought, ...]]:
    """Return the causes that change something, each change with the number of its cause, and the findings of each.

    The number is None where no cause has a change.

    Causes that cannot be tried alone, such as a device and its controllers, are one. What comes from elsewhere, such as
    a comment that excuses a finding or a file that the spec names, has none.
    """
    trials = [_tried(cause, before, after) for cause in causes]
    alone = [cause for cause, trial in zip(causes, trials, strict=True) if trial.valid]
    together = tuple(edit for cause, trial in zip(causes, trials, strict=True) if not trial.valid for edit in cause)
    known = [trial.changes for trial in trials if trial.valid]
    rest = len(alone) if together else None
    held = [(change, *_held(change, [len(set(map(alike, cause))) for cause in alone], known)) for change in changes]
    found = [
        (_cause_of(change, held_by, known, rest), change) for change, held_by, is_repeated in held if not is_repeated
    ]
    found = without_lines(found)
    if not together:
        found = _with_last(found, alone, before, after)
    if (
        not together
        and all(map(_has_facts, known))
        and all(_is_of_lines(change) for number, change in found if number is None)
    ):
        # Lines of documents have no source but lines of the spec, each of which has facts.
        found = [(number, change) for number, change in found if number is not None]
    if together:
        together = _leading_first(together, [change for number, change in found if number == rest])
    kept = sorted({number for number, _ in found if number is not None})
    every = (*alone, together)
    brought = [trial.brought for trial in trials if trial.valid]
    new = frozenset(map(said_of, more(after.findings, before.findings)))
    # What none brings alone, those bring that cannot be tried alone.
    brought.append(new.difference(*brought))
    return (
        tuple(every[number] for number in kept),
        [(None if number is None else kept.index(number), change) for number, change in found],
        tuple(brought[number] for number in kept),
    )


def _with_last(
    found: Sequence[tuple[int | None, Change]], causes: Sequence[Cause], before: State, after: State
) -> list[tuple[int | None, Change]]:
    """Return changes with the cause without which they are not there, where no cause makes them by itself."""
    keys = [_key(change) for number, change in found if number is None and _is_open(change)]
    needed = dict[tuple[str, str], int]()
    for number, cause in enumerate(causes if keys else ()):
        document = with_edits(after.document, undone(cause), before.document)
        without = package_of_document(document, before.errors | after.errors)
        if without is not None:
            left = _by_key(reported(before.facts, without.facts))
            needed = {**{key: number for key in keys if key not in left}, **needed}
    return [
        (needed.get(_key(change)) if number is None and _is_open(change) else number, change)
        for number, change in found
    ]


def _is_open(change: Change) -> bool:
    return change.area is not ReviewArea.GATES and not _is_of_lines(change)


def _leading_first(cause: Cause, changes: Sequence[Change]) -> Cause:
    """Return the edits of a cause that cannot be tried one by one: a model first, or whose name most changes hold."""

    def held(edit: SpecEdit) -> int:
        name = re.compile(rf"(?<!\w){re.escape(str(edit.path[-1]))}(?!\w)")
        return sum(
            any(name.search(text or "") for text in (change.subject, change.before, change.after)) for change in changes
        )

    first = max(cause, key=lambda edit: (is_model(edit.path), held(edit)))
    return (first, *(edit for edit in cause if edit is not first))


def _held(change: Change, lengths: Sequence[int], known: Sequence[_Changes]) -> tuple[Sequence[int], bool]:
    """Return the causes that make a change by themselves, and whether it repeats a fact of each of them.

    A value that repeats others is left out where one line of the spec makes it, beside a change of at least its grade;
    lines of documents where each cause that changes them has facts.
    """
    having = [number for number, changes in enumerate(known) if _key(change) in changes]
    if not change.follows or not having:
        return having, False
    if _is_of_lines(change):
        bare = [number for number in having if not _has_facts(known[number])]
        return bare or having, not bare
    worst = [
        max((_place(each) for each in known[number].values() if not each.follows), default=-1) for number in having
    ]
    is_whole = len(having) > 1 or known[having[0]][_key(change)].after == change.after
    is_one = all(lengths[number] == 1 for number in having)
    return having, is_whole and is_one and min(worst) >= _place(change)


def without_lines(found: Sequence[tuple[int | None, Change]]) -> list[tuple[int | None, Change]]:
    """Return changes without the lines of documents and the looks that a cause changes beside facts."""
    having = {number for number, change in found if number is not None and not _is_look(change)}
    return [(number, change) for number, change in found if number not in having or not _is_look(change)]


def _is_look(change: Change) -> bool:
    return _is_of_lines(change) or (change.follows and change.grade is Grade.SAFE)


def _has_facts(changes: _Changes) -> bool:
    return any(not _is_of_lines(change) for change in changes.values())


def _place(change: Change) -> int:
    return tuple(Grade).index(change.grade)


def _is_of_lines(change: Change) -> bool:
    return change.follows and change.quantity.endswith(UNCLASSIFIED)


def _cause_of(change: Change, having: Sequence[int], known: Sequence[_Changes], rest: int | None) -> int | None:
    exact = [number for number in having if known[number][_key(change)].after == change.after]
    return next(iter((*exact, *having)), rest)


def _tried(cause: Cause, before: State, after: State) -> _Trial:
    known = before.errors | after.errors
    alone = package_of_document(with_edits(before.document, cause, after.document), known)
    if alone is not None:
        return _trial(before.facts, before.findings, alone.facts, alone.findings)
    without = package_of_document(with_edits(after.document, undone(cause), before.document), known)
    if without is not None:
        return _trial(without.facts, without.findings, after.facts, after.findings)
    return _Trial({}, valid=False)


def _trial(was: Facts, known: Sequence[ReviewFinding], now: Facts, found: Sequence[ReviewFinding]) -> _Trial:
    return _Trial(_by_key(reported(was, now)), valid=True, brought=frozenset(map(said_of, more(found, known))))


def package_of_document(document: SourceDocument, known: Collection[str] = ()) -> Package | None:
    """Return the package of a spec in memory; None where the spec has an error that is not known."""
    checked = check_document(document)
    codes = {found.code for found in checked.diagnostics if found.severity is Severity.ERROR}
    if not codes <= {*known}:
        return None
    try:
        return package_of(document.file, checked)
    except SideError:
        return None


def _by_key(changes: Sequence[Change]) -> dict[tuple[str, str], Change]:
    # A fact counts before what repeats it.
    return {_key(change): change for change in sorted(changes, key=lambda change: not change.follows)}


def _key(change: Change) -> tuple[str, str]:
    # A cause alone may be graded otherwise, and with that in another area: a pose without its new revision.
    return change.subject, UNCLASSIFIED if _is_of_lines(change) else change.quantity


def as_cause(cause: Cause, document: SourceDocument | None = None) -> ReviewCause:
    """Return a cause as a review lists it: its line, or the part of the spec that holds its lines.

    Args:
        document: the spec whose entries of lists have names there: the joint of a first motion, the kind of a fault.
    """
    first = cause[0]
    if len(cause) == 1:
        before, after = texts_of(first) if None not in (first.before, first.after) else described(first)
        return ReviewCause(line=_dotted(first.path, document), before=before, after=after, place=str(first.place))
    common = _part_of(cause)
    values = tuple(
        ReviewValue(
            line=_dotted(edit.path, document, len(common) if edit.path[: len(common)] == common else 0),
            before=was,
            after=now,
            place=str(edit.place),
        )
        for edit in cause
        for was, now in [texts_of(edit)]
    )
    return ReviewCause(
        line=_dotted(common, document) or WHOLE_SPEC,
        after=shortened(", ".join(value.line for value in values)),
        place=str(first.place),
        lines=len(cause),
        values=values,
    )


def _part_of(cause: Cause) -> YamlPath:
    """Return the part of the spec that a cause is of: a device with another model, a calibration, or what all have."""
    models = [edit.path[:2] for edit in cause if is_model(edit.path)]
    measured = [edit.path[:2] for edit in cause if edit.path[:1] == MEASURED]
    if len(models) == 1 or (measured and not models):
        return (*models, *measured)[0]
    return _common(cause)


def _common(cause: Cause) -> YamlPath:
    first = cause[0].path
    length = next((at for at in range(len(first)) if any(edit.path[: at + 1] != first[: at + 1] for edit in cause)), 0)
    return first[:length]


def _dotted(path: YamlPath, document: SourceDocument | None, start: int = 0) -> str:
    parts = (
        _entry(path[: at + 1], document) if isinstance(path[at], int) else path[at] for at in range(start, len(path))
    )
    return ".".join(map(str, parts))


def _entry(path: YamlPath, document: SourceDocument | None) -> str:
    """Return what an entry of a list is called: by its joint, else by its number from 1 with its first value."""
    child = None if document is None else document.child(path)
    inner = {} if child is None else child.node.children
    if _JOINT in inner:
        return inner[_JOINT].node.text
    first = next((f" ({key} {each.node.text})" for key, each in inner.items()), "")
    return f"{int(path[-1]) + 1}{first}"
