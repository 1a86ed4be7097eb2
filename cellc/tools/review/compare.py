"""Two packages into changes: facts compared by the table; lines of files where no fact explains a difference."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from cellc.contract.diagnostics.wording import count
from cellc.contract.grading import Graded, Rule
from cellc.contract.vocabulary import UNKNOWN, Grade, ReviewArea
from cellc.tools.review.carried import is_reaching
from cellc.tools.review.change import PRESENT, Change, Figures
from cellc.tools.review.effects import effects
from cellc.tools.review.facts import OF_GATES, OF_SPEC, Facts
from cellc.tools.review.geometry import place_difference
from cellc.tools.review.grading import ELSEWHERE, grade
from cellc.tools.review.joint_units import of_joints, unit_of_leaf, units_of
from cellc.tools.review.leaves import Delta, Leaf, Path, as_json, differences, flatten, prefixes, same, words
from cellc.tools.review.lines import Known, LinesLeft, lines_left
from cellc.tools.review.loads import assumed_part
from cellc.tools.review.programs import area_of_parameter
from cellc.tools.review.reasons import as_held, owner_without_approval
from cellc.tools.review.repeated import follows, is_covered, is_derived, is_stated, spelled
from cellc.tools.review.replaced import PAIRS, with_models
from cellc.tools.review.rooms import box_difference, room_difference
from cellc.tools.review.rows import ROWS
from cellc.tools.review.rules import (
    AREA_OF_FILE,
    THINGS,
    Fit,
    Row,
    Thing,
    fits,
    is_stop_timing,
    quantity_of,
)
from cellc.tools.review.steps import with_step_names
from cellc.tools.review.units import difference, shown, unit_in

_MADE_FROM = re.compile(r"\bcellc build (?:'[^']*'|[^\s`]+)")
"""A spec that was moved makes the same package: its path is in the head of every file."""

_SAID_ELSEWHERE = ("places", "summary", "owners")
"""Of a cell: where its author wrote what, and what its configuration does not rest on."""
_SHOWN_LINES = 3
_IDLE = ("versions", "transition")
"""Kinds of requests that move nothing: they compare, or start a node that is managed."""
UNCLASSIFIED = "(not classified)"
"""How the quantity of lines ends that no row of the table explains."""
WHOLE = "cell"
"""Subject of what belongs to the cell itself."""
_PINNED = ("contract", "version_tuple")
_SHOWS = ("graph/", "README.md", "sim/")
"""Files that show people and simulators what the others say: they are reported where a hand edited them."""


def reported(before: Facts, after: Facts) -> list[Change]:
    """Return every change by itself, in the order of what tells it."""
    # What only specs say is compared where both sides were made of one.
    both = before.cell is not None and after.cell is not None
    before = replace(before, leaves=with_step_names(before.leaves, after.leaves))
    one_sided = (*(() if both else OF_SPEC), *(() if before.has_gates and after.has_gates else OF_GATES))
    deltas = [
        difference for difference in differences(before.leaves, after.leaves) if difference.path[0] not in one_sided
    ]
    things, rest = _things(deltas, before, after)
    rest, pins = _pins(rest)
    changed = [(delta, change) for delta in rest if (change := change_of(delta, before, after)) is not None]
    values = [(delta, change) for delta, change in changed if not follows(delta.path)]
    reported = [*things, *effects(before, after)]
    reported += [_with_matrix(change, pins, before, after) for _, change in values]
    reported += [
        replace(change, follows=True)
        for delta, change in changed
        if follows(delta.path) and (before.edited or after.edited or not is_derived(delta.path))
        if not is_stated(delta, change, values, things)
    ]
    ids, edited = _ids(before) | _ids(after), before.edited | after.edited
    renamed = before.contract.cell != after.contract.cell
    sides = [_lines_of(facts, renamed) for facts in (before, after)]
    left = [
        item
        # Nothing explains what a person wrote into a file of the package.
        for by_hand, known in ((False, _known(reported, ids)), (True, Known(ids, frozenset(), frozenset())))
        for was, now in [[{file: side[file] for file in side if (file in edited) is by_hand} for side in sides]]
        for item in lines_left(was, now, known)
    ]
    reported += [_of_lines(item) for item in left if item.file in edited or not item.file.startswith(_SHOWS)]
    reported = [change for change in reported if not _is_of_one_link(change, before, after)]
    return with_models(reported, before, after) or list(_unexplained(before, after))


def _is_of_one_link(change: Change, before: Facts, after: Facts) -> bool:
    """Tell whether a pair is one of a link that one side alone has, which its own shapes and device tell."""
    if change.quantity not in PAIRS:
        return False
    was, now = ({link.name for link in side.description.links} for side in (before, after))
    return not (was ^ now).isdisjoint(change.subject.split(" with "))


def _unexplained(before: Facts, after: Facts) -> Iterator[Change]:
    """Yield that two cells are not the same, where no file of theirs shows in what."""
    was, now = before.manifest.configuration_inputs.cell_sha256, after.manifest.configuration_inputs.cell_sha256
    if not was or not now or was == now:
        return
    found = list[Delta]()
    if before.cell is not None and after.cell is not None:
        cells = (dict(flatten(as_json(before.cell))), dict(flatten(as_json(after.cell))))
        found = [difference for difference in differences(*cells) if difference.path[0] not in _SAID_ELSEWHERE]
    for delta in found:
        yield Change(
            ReviewArea.GATES,
            " ".join(delta.path),
            "value that no file of the package shows",
            shown(delta.before, unit_in(delta.path[-1])),
            shown(delta.after, unit_in(delta.path[-1])),
            Grade.REVIEW,
        )
    if not found:
        told = "value that these folders do not hold; compare the specs"
        yield Change(ReviewArea.GATES, WHOLE, told, was[:12], now[:12], Grade.DANGEROUS)


def _lines_of(facts: Facts, renamed: bool) -> Mapping[str, Sequence[str]]:
    """Return the lines of every file, without what each repeats: where the spec lies, and a name that changed."""
    opened = {
        file: tuple(_MADE_FROM.sub("cellc build SPEC", line) for line in lines) for file, lines in facts.lines.items()
    }
    if not renamed:
        return opened
    name = re.compile(rf"(?<!\w){re.escape(facts.contract.cell)}(?!\w)")
    return {file: tuple(name.sub("CELL", line) for line in lines) for file, lines in opened.items()}


def _ids(facts: Facts) -> frozenset[str]:
    """Return what follows from reported changes: ids, and names of files."""
    inputs, files = facts.manifest.configuration_inputs, facts.contract.files
    ids = (facts.contract.configuration_id, inputs.urdf_sha256, inputs.cell_sha256)
    return frozenset((*ids, files.urdf_mock, files.urdf_real, files.srdf or ""))


def _known(reported: Iterable[Change], ids: frozenset[str]) -> Known:
    changes = list(reported)
    return Known(
        frozenset().union(ids, *(change.words for change in changes)),
        frozenset().union(*(spelled(change.names) for change in changes)),
        frozenset().union(*(change.differing for change in changes)),
    )


def _differing(before: Leaf | None, after: Leaf | None) -> frozenset[str]:
    """Return the words that one side alone has, and their parts; a figure alone is no name of anything."""
    alone = {*words(before)} ^ {*words(after)}
    parts = {part for word in alone for part in (word, *word.split("/"))}
    return frozenset(part for part in parts if not part.replace(".", "", 1).lstrip("-").isdigit() and len(part) > 1)


def _things(deltas: Sequence[Delta], before: Facts, after: Facts) -> tuple[list[Change], list[Delta]]:
    """Take out what was added or removed as a whole, and return it with the values that are left."""
    old, new = prefixes(before.leaves), prefixes(after.leaves)
    folded: dict[tuple[Path, Thing], list[Delta]] = {}
    rest = []
    for delta in deltas:
        place = next(_folds(delta.path, old, new), None)
        if place is None:
            rest.append(delta)
        else:
            folded.setdefault(place, []).append(delta)
    things = [(thing, _of_thing(path, thing, inner, (before, after))) for (path, thing), inner in folded.items()]
    reported = [change for thing, change in things if not thing.follows]
    return reported + [change for thing, change in things if thing.follows and not is_covered(change, reported)], rest


def _folds(path: Path, old: frozenset[Path], new: frozenset[Path]) -> Iterator[tuple[Path, Thing]]:
    for length in range(1, len(path) + 1):
        prefix = path[:length]
        if (prefix in old) is not (prefix in new):
            yield from ((prefix, thing) for thing in THINGS if fits(thing.parts, prefix) is not None)


def _of_thing(path: Path, thing: Thing, inner: Sequence[Delta], sides: tuple[Facts, Facts]) -> Change:
    added = inner[0].before is None
    fit = fits(thing.parts, path)
    names = () if fit is None else fit.subject
    shown_leaf = next((delta for delta in inner if delta.path == (*path, thing.shown)), None)
    value = PRESENT if shown_leaf is None else shown(shown_leaf.after if added else shown_leaf.before, "")
    idle = added and any(delta.path[-2:] == ("request", "kind") and delta.after in _IDLE for delta in inner)
    held = any(delta.path[len(path)] == thing.holds for delta in inner if len(delta.path) > len(path))
    compared = next((delta for delta in inner if delta.path[-2:] == ("request", "parts")), None)
    if compared is not None and not added:
        removed = grade(Rule.COMPARED, compared, *sides).grade
    else:
        removed = thing.removed if held or not thing.holds else Grade.REVIEW
    taken = removed if not added else Grade.REVIEW if idle else thing.added
    stranger = owner_without_approval(inner, sides) if added else ""
    reaches = added and path[:2] == ("contract", "devices") and is_reaching(sides[1].contract, path[2])
    return Change(
        area_of_parameter(thing.noun, path, sides) or thing.area,
        " ".join(names),
        f"{thing.noun} {'added' if added else 'removed'}",
        None if added else value,
        value if added else None,
        Grade.DANGEROUS if reaches else taken,
        breaking=thing.breaking and not added,
        why=ELSEWHERE if reaches else thing.why.format(" ".join(names)) if taken is Grade.DANGEROUS else stranger,
        approval="safety" if reaches else None,
        asks=thing.asks,
        words=frozenset(word for delta in inner for word in (*words(delta.before), *words(delta.after), *delta.path)),
        names=frozenset(names[-1:]),
    )


def _pins(deltas: Sequence[Delta]) -> tuple[list[Delta], dict[str, Delta]]:
    """Take out what the matrix says of pins that changed themselves: a pin is listed once."""
    pinned = {delta.path[2] for delta in deltas if delta.path[:2] == _PINNED}
    judged = {delta.path[1]: delta for delta in deltas if delta.path[0] == "matrix" and delta.path[1] in pinned}
    return [delta for delta in deltas if delta not in judged.values()], judged


def _with_matrix(change: Change, pins: Mapping[str, Delta], before: Facts, after: Facts) -> Change:
    delta = pins.get(change.subject) if change.quantity == "pinned version" else None
    if delta is None:
        return change
    verdict = grade(Rule.MATRIX, delta, before, after)
    # A pin that was not known takes nothing away where the matrix does not know it either.
    is_known_now = change.before == UNKNOWN and verdict.grade is not Grade.DANGEROUS
    worse = change.grade if is_known_now else max(change.grade, verdict.grade, key=tuple(Grade).index)
    was, now = (shown(leaf, "") or "nothing" for leaf in (delta.before, delta.after))
    said = f"the compatibility matrix says {now}, before {was}"
    known = change.words | {*words(delta.before), *words(delta.after)}
    return replace(change, grade=worse, why="; ".join(filter(None, (change.why, said))), words=known)


def change_of(delta: Delta, before: Facts, after: Facts) -> Change | None:
    """Return a value that changed as a change; None where its order alone did, and that says nothing."""
    row, fit = _row(delta.path)
    if (
        delta.before is not None
        and delta.after is not None
        and same(delta.before, delta.after, ordered=row.grade.ordered)
    ):
        return None
    units = units_of(row.grade.unit or unit_of_leaf(delta.path, before, after), fit.subject, before, after)
    figures = Figures(*of_joints(delta, before, after), units, row.grade.share)
    was, now, size = figures.texts()
    verdict = grade(row.grade.rule, delta, before, after)
    if delta.path[0] == "pair" and None in (delta.before, delta.after):
        return _of_pair(delta, row, verdict.grade)
    return Change(
        verdict.area or area_of_parameter(row.grade.quantity, delta.path, (before, after)) or row.grade.area,
        " ".join(fit.subject) or WHOLE,
        quantity_of(row, fit),
        _endless(delta.path, before) if was is None else was,
        _endless(delta.path, after) if now is None else now,
        verdict.grade,
        _difference(delta, before, after) or size,
        row.grade.breaking and delta.before is not None,
        verdict.why
        or (
            _why(row, fit, after)
            if verdict.grade is Grade.DANGEROUS
            else assumed_part(delta.path, after) or owner_without_approval([delta], (before, after))
        ),
        verdict.approval or ("safety" if is_stop_timing(row, delta.path, before.leaves) else None),
        row.grade.asks,
        None if _difference(delta, before, after) else figures,
        words=frozenset((*words(delta.before), *words(delta.after), *delta.path)),
        differing=_differing(delta.before, delta.after),
    )


def _why(row: Row, fit: Fit, after: Facts) -> str:
    return as_held(row.grade.why, next(iter(fit.subject), ""), after.contract)


def _endless(path: Path, facts: Facts) -> str | None:
    """Return what is said of a joint that turns without end where a limit of its position would be; else None."""
    joint = next((each for each in facts.description.joints if each.name == path[2]), None) if len(path) > 2 else None
    is_limit = path[:2] == ("contract", "joint_limits") and path[-1] in ("lower", "upper")
    return "no end (continuous)" if is_limit and joint is not None and joint.type == "continuous" else None


def _difference(delta: Delta, before: Facts, after: Facts) -> str:
    """Return how much a box or a place differs, which is more than its values; empty of anything else."""
    if delta.path[::2] == ("area", "size"):
        return box_difference(delta.path, before, after)
    if delta.path[:2] == ("real", "shapes"):
        told = box_difference(delta.path, before, after)
        if told:
            return told
        if isinstance(delta.before, tuple) and isinstance(delta.after, tuple) and len(delta.before) > 1:
            same_ones = sum((Counter(delta.before) & Counter(delta.after)).values())
            return f"{len(delta.before) - same_ones} of {len(delta.before)} replaced by {len(delta.after) - same_ones}"
    if delta.path[:1] != ("placement",):
        return ""
    moved, room = place_difference(delta.path[1], before, after), room_difference(delta.path[1], before, after)
    stated = difference(delta.before, delta.after, "") if room else ""
    return "; ".join(part for part in (moved or stated, room) if part)


def _of_pair(delta: Delta, row: Row, taken: Grade) -> Change:
    """Return that a pair of links is checked for collision now, or is not any more, as a person reads it."""
    before, after = ("checked" if leaf is None else f"not checked ({leaf})" for leaf in (delta.before, delta.after))
    return Change(
        row.grade.area,
        " with ".join(delta.path[1].split(" and ")),
        PAIRS[delta.after is not None],
        before,
        after,
        taken,
        words=frozenset((*words(delta.before), *words(delta.after), *delta.path)),
        differing=_differing(delta.before, delta.after),
    )


def _row(path: Path) -> tuple[Row, Fit]:
    for row in ROWS:
        fit = fits(row.parts, path)
        if fit is not None:
            return row, fit
    in_file = path[0] == "file"
    area = area_of_file(path[1]) if in_file else ReviewArea.DOCUMENTS
    return Row("", Graded(area, "value")), Fit(path[1:2] if in_file else path[:1], path[2:] if in_file else path[1:])


def area_of_file(file: str) -> ReviewArea:
    """Return what a file of the package concerns, where nothing else tells it."""
    return next((area for start, area in AREA_OF_FILE if file.startswith(start)), ReviewArea.DOCUMENTS)


def _of_lines(left: LinesLeft) -> Change:
    area = area_of_file(left.file)
    text = count(max(len(left.before), len(left.after)), "line")
    return Change(
        area,
        left.file,
        f"file {left.whole}" if left.whole else f"{text} {UNCLASSIFIED}",
        text if left.whole == "removed" else _some(left.before),
        text if left.whole == "added" else _some(left.after),
        Grade.REVIEW,
        follows=True,
    )


def _some(lines: Sequence[str]) -> str | None:
    more = len(lines) - _SHOWN_LINES
    return " / ".join((*lines[:_SHOWN_LINES], *([f"and {more} more"] if more > 0 else []))) or None
