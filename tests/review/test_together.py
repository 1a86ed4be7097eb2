"""Changes do not hide each other: several in one review tell at least what each of them tells alone.

A session takes a few leaves of each cell, with ``--long`` every fifth. Those that change what others are about, such as
the model of a device, are left out: what they tell together is another story.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence

import pytest

from cellc.compiler.pipeline import Checked
from cellc.tools.review.change import Change
from cellc.tools.review.compare import UNCLASSIFIED, reported
from cellc.tools.review.sides import package_of
from tests.cells import EVERY_CELL
from tests.review.edits import package_before, review_of
from tests.review.leaves import SpecLeaf, changed, leaves_of, with_texts
from tests.review.revisions import Edit

_FEW, _MANY = 3, 60
_TOGETHER = 4
_TELLS_OF_OTHERS = 10

Told = frozenset[tuple[str, str]]


def _told(checked: Checked, cell: str) -> Told:
    """Return what is told by subject and quantity, without lines of documents."""
    changes = reported(package_before(cell).facts, package_of("after", checked).facts)
    return frozenset((change.subject, change.quantity) for change in changes if _is_fact(change))


def _is_fact(change: Change) -> bool:
    return UNCLASSIFIED not in change.quantity and "no file of the package" not in change.quantity


def _alone(leaves: Sequence[SpecLeaf], cell: str) -> dict[SpecLeaf, tuple[str, Told]]:
    """Return what each leaf tells alone, of those that say nothing of other parts."""
    found = {}
    for leaf in leaves:
        other = changed(leaf)
        told = frozenset() if other is None else _told(other[1], cell)
        comes_or_goes = any(quantity.endswith((" added", " removed")) for _, quantity in told)
        if other is not None and 0 < len(told) <= _TELLS_OF_OTHERS and not comes_or_goes:
            found[leaf] = other[0], told
    return found


def _sets(leaves: Sequence[SpecLeaf]) -> list[list[SpecLeaf]]:
    """Return leaves a few at a time, no two of one part of the spec."""
    sets = list[list[SpecLeaf]]()
    for leaf in leaves:
        fitting = (each for each in sets if len(each) < _TOGETHER and all(_part(leaf) != _part(it) for it in each))
        room = next(fitting, None)
        if room is None:
            sets.append([leaf])
        else:
            room.append(leaf)
    return sets


def _part(leaf: SpecLeaf) -> tuple[object, ...]:
    return leaf.path[:3] if leaf.path[0] in ("control", "managers", "motion") else leaf.path[:2]


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_changes_together_tell_what_each_tells_alone(cell: str, request: pytest.FixtureRequest) -> None:
    ranked = sorted(leaves_of(cell), key=lambda leaf: zlib.crc32(f"{leaf.name} together".encode()))
    alone = _alone(ranked[: _MANY if request.config.option.long else _FEW], cell)
    swallowed, tried = dict[str, list[tuple[str, str]]](), 0
    for leaves in _sets(tuple(alone)):
        checked = with_texts({leaf: alone[leaf][0] for leaf in leaves})
        if len(leaves) < 2 or not checked.ok:
            continue
        tried += 1
        together = _told(checked, cell)
        for leaf in leaves:
            missing = sorted(alone[leaf][1] - together)
            if missing:
                beside = [f"{it.name}: {it.text} -> {alone[it][0]}" for it in leaves if it is not leaf]
                swallowed[f"{leaf.name}: {leaf.text} -> {alone[leaf][0]} beside {beside}"] = missing
    assert swallowed == {}
    assert tried or len(alone) < _FEW // 2


_WALL: Edit = ("the nearest is 3 m away", "the nearest is 4 m away")


@pytest.mark.parametrize(
    ("cell", "one", "other", "quantity"),
    [
        # Each of the other lines has the words and figures of the first on its two sides.
        ("ur5e_pick", _WALL, ("reference_points: 3", "reference_points: 4"), "reason why there is nothing"),
        ("fr3_hand", _WALL, ("reference_points: 3,\n", "reference_points: 4,\n"), "reason why there is nothing"),
        (
            "ur5e_pick",
            ("played_by: operator", "played_by: integration"),
            ("observer: operator", "observer: integration"),
            "who starts the program",
        ),
        (
            "ur5e_pick",
            ("mode: local", "mode: remote"),
            ("walls: {none: the nearest is 3 m away", "walls: {none: no remote wall and a local one"),
            "mode for the program",
        ),
    ],
)
def test_the_same_words_in_another_line_hide_nothing(cell: str, one: Edit, other: Edit, quantity: str) -> None:
    alone = next(each for each in review_of(cell, one).changes if each.quantity == quantity)
    beside = next(each for each in review_of(cell, one, other).changes if each.quantity == quantity)
    assert (beside.subjects, beside.before, beside.after, beside.grade) == (
        alone.subjects,
        alone.before,
        alone.after,
        alone.grade,
    )
    told = review_of(cell, one, other)
    assert len({change.cause for change in told.changes}) == 2
