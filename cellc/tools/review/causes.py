"""Which lines of a spec cause which changes: each is tried alone, on the state before, or undone in that after."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from cellc.compiler.pipeline import check_document
from cellc.compiler.source.document import Child, SourceDocument
from cellc.contract.diagnostics import YamlPath
from cellc.contract.review import ReviewCause, ReviewValue
from cellc.contract.vocabulary import Grade
from cellc.tools.review.change import Change
from cellc.tools.review.compare import UNCLASSIFIED, reported
from cellc.tools.review.facts import Facts
from cellc.tools.review.sides import SideError, package_of
from cellc.tools.review.spec_edits import SpecEdit, spec_edits, undone, with_edits
from cellc.tools.review.titles import WHOLE_SPEC

_MOST = 20
"""Causes that are tried one by one; of more edits, those of one part of the spec are one cause."""
_TOGETHER = 3
"""Values of one mapping that are listed as one: of a calibration, its revision, its day and its residual."""
_AS_ONE = ("payload",)
"""Mappings whose values are listed as one however few they are: a mass and where it is."""
_POSE = ("xyz", "rpy")
"""Keys of a place: where something is and how it is turned count together."""
_MEASURED, _REVISION, _CALIBRATION = ("calibrations",), "revision", "calibration"
_ROOMS, _PLACED = ("scene", "areas"), 3
"""Sections whose entries take up room: where it is and how large count together."""
_LONGEST, _BESIDE = 60, 12
"""Characters of a value that a heading has, and of what is the same before those that differ."""

Cause: TypeAlias = tuple[SpecEdit, ...]
"""Edits of a spec that are listed as one."""
_Changes: TypeAlias = Mapping[tuple[str, str], Change]
"""Changes by subject and quantity."""


@dataclass(frozen=True, slots=True)
class State:
    """A spec with the facts of the package that is made of it."""

    document: SourceDocument
    facts: Facts


@dataclass(frozen=True, slots=True)
class _Trial:
    """What a cause changes by itself; not valid where the spec has errors both with it alone and with all but it."""

    changes: _Changes
    valid: bool


def causes_between(before: SourceDocument, after: SourceDocument) -> tuple[Cause, ...]:
    """Return the edits between two states of a spec, those of one part as one where there are many.

    What a new measurement found is one with it: the calibration, and the poses that it measured.
    """
    edits = spec_edits(before, after)
    renewed = {edit.path[1] for edit in edits if edit.path[:1] == _MEASURED and len(edit.path) > len(_MEASURED) + 1}
    beside = Counter(edit.path[:-1] for edit in edits)
    alike = Counter(map(_alike, edits))
    parts = [_part(edit.path, beside, after, renewed) for edit in edits]
    # Lines that are alike, of several devices or interfaces, are one.
    parts = [
        _alike(edit) if part == edit.path and len(part) > 2 and alike[_alike(edit)] > 1 else part
        for edit, part in zip(edits, parts, strict=True)
    ]
    causes = _grouped(edits, parts)
    causes = tuple(tuple(sorted(cause, key=_place_in_measurement)) for cause in causes)
    for depth in (3, 2, 1):
        if len(causes) > _MOST:
            causes = _grouped(edits, [edit.path[:depth] for edit in edits])
    return causes


def _part(
    path: YamlPath, beside: Mapping[YamlPath, int], after: SourceDocument, renewed: Collection[object]
) -> YamlPath:
    """Return the part of the spec that an edit is listed with: itself where it is listed alone."""
    if path[-1] in _POSE and (name := after.text_at((*path[:-1], _CALIBRATION))) in renewed:
        return *_MEASURED, name
    if path[:1] == _MEASURED and path[1] in renewed:
        return path[:2]
    return path[:-1] if _is_together(path, beside) else path


def _alike(edit: SpecEdit) -> YamlPath:
    return "=", edit.path[0], *edit.path[2:], *map(str, texts_of(edit))


def _place_in_measurement(edit: SpecEdit) -> int:
    """Return which edit of a new measurement is first: its revision, then what it moved, then the rest of it."""
    if edit.path[:1] != _MEASURED:
        return 1
    return 0 if edit.path[-1] == _REVISION else 2


def _is_together(path: YamlPath, beside: Mapping[YamlPath, int]) -> bool:
    is_one = path[-1] in _POSE or (path[-2:-1] and path[-2] in _AS_ONE) or (len(path) == _PLACED and path[0] in _ROOMS)
    return beside[path[:-1]] >= (2 if is_one else _TOGETHER)


def _grouped(edits: Sequence[SpecEdit], paths: Sequence[YamlPath]) -> tuple[Cause, ...]:
    grouped: dict[YamlPath, list[SpecEdit]] = {}
    for edit, path in zip(edits, paths, strict=True):
        grouped.setdefault(path, []).append(edit)
    return tuple(map(tuple, grouped.values()))


def attributed(
    changes: Sequence[Change], causes: Sequence[Cause], before: State, after: State
) -> tuple[tuple[Cause, ...], list[tuple[int | None, Change]]]:
    """Return the causes that change something, and each change with the number of its cause; None where none has it.

    Causes that cannot be tried alone, such as a device and its controllers, are one. What comes from elsewhere, such as
    a comment that excuses a finding or a file that the spec names, has none.
    """
    trials = [_tried(cause, before, after) for cause in causes]
    alone = [cause for cause, trial in zip(causes, trials, strict=True) if trial.valid]
    together = tuple(edit for cause, trial in zip(causes, trials, strict=True) if not trial.valid for edit in cause)
    known = [trial.changes for trial in trials if trial.valid]
    rest = len(alone) if together else None
    held = [(change, *_held(change, [len(set(map(_alike, cause))) for cause in alone], known)) for change in changes]
    found = [
        (_cause_of(change, held_by, known, rest), change) for change, held_by, is_repeated in held if not is_repeated
    ]
    found = without_lines(found)
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
    return (
        tuple(every[number] for number in kept),
        [(None if number is None else kept.index(number), change) for number, change in found],
    )


def is_model(path: YamlPath) -> bool:
    """Tell whether a value of a spec is the model of a device, which more follows from than from any other."""
    return path[:1] == ("devices",) and path[2:] == ("model",)


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
    alone = facts_of_document(with_edits(before.document, cause, after.document))
    if alone is not None:
        return _Trial(_by_key(reported(before.facts, alone)), valid=True)
    without = facts_of_document(with_edits(after.document, undone(cause), before.document))
    if without is not None:
        return _Trial(_by_key(reported(without, after.facts)), valid=True)
    return _Trial({}, valid=False)


def facts_of_document(document: SourceDocument) -> Facts | None:
    """Return what the package of a spec in memory says; None where the spec has errors."""
    try:
        return package_of(document.file, check_document(document)).facts
    except SideError:
        return None


def _by_key(changes: Sequence[Change]) -> dict[tuple[str, str], Change]:
    # A fact counts before what repeats it.
    return {_key(change): change for change in sorted(changes, key=lambda change: not change.follows)}


def _key(change: Change) -> tuple[str, str]:
    # A cause alone may be graded otherwise, and with that in another area: a pose without its new revision.
    return change.subject, UNCLASSIFIED if _is_of_lines(change) else change.quantity


def as_cause(cause: Cause) -> ReviewCause:
    """Return a cause as a review lists it: its line, or the part of the spec that holds its lines."""
    first = cause[0]
    if len(cause) == 1:
        before, after = texts_of(first)
        return ReviewCause(line=_dotted(first.path), before=before, after=after, place=str(first.place))
    common = first.path[:2] if first.path[:1] == _MEASURED else _common(cause)
    values = tuple(
        ReviewValue(
            line=_dotted(edit.path[len(common) if edit.path[: len(common)] == common else 0 :]),
            before=was,
            after=now,
            place=str(edit.place),
        )
        for edit in cause
        for was, now in [texts_of(edit)]
    )
    return ReviewCause(
        line=_dotted(common) or WHOLE_SPEC,
        after=_short(", ".join(value.line for value in values)),
        place=str(first.place),
        lines=len(cause),
        values=values,
    )


def _common(cause: Cause) -> YamlPath:
    first = cause[0].path
    length = next((at for at in range(len(first)) if any(edit.path[: at + 1] != first[: at + 1] for edit in cause)), 0)
    return first[:length]


def _dotted(path: YamlPath) -> str:
    return ".".join(map(str, path))


def texts_of(edit: SpecEdit) -> tuple[str | None, str | None]:
    """Return both values of an edit in one line; of long ones the part that differs."""
    was, now = (None if child is None else _flow(child) for child in (edit.before, edit.after))
    if was is None or now is None:
        return None if was is None else _short(was), None if now is None else _short(now)
    if max(len(was), len(now)) > _LONGEST:
        alike = next((at for at, (one, other) in enumerate(zip(was, now, strict=False)) if one != other), len(was))
        start = was.rfind(" ", 0, max(alike - _BESIDE, 0)) + 1
        was, now = (f"...{text[start:]}" if start else text for text in (was, now))
    return _short(was), _short(now)


def flow_of(child: Child) -> str:
    """Return a value in one line, cut where it is long."""
    return _short(_flow(child))


def _short(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def _flow(child: Child) -> str:
    """Return a value in one line, as YAML has it in flow style."""
    node = child.node
    if not node.is_collection:
        return node.text
    inner = [_flow(each) for each in node.children.values()]
    if isinstance(node.data, list):
        return f"[{', '.join(inner)}]"
    return "{" + ", ".join(f"{key}: {text}" for key, text in zip(node.children, inner, strict=True)) + "}"
