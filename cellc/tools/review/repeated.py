"""Values that repeat others: which of them say, exactly, what another change has said.

Nothing is left out because it has words in common with another change. Left out here is a value that says the same of
the same part, and one that appears or vanishes with a part by its name; which line of the spec a value comes from is
known by `causes`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import PurePosixPath

from cellc.contract.vocabulary import Grade
from cellc.tools.review.change import Change
from cellc.tools.review.leaves import Delta, Leaf, Path, words
from cellc.tools.review.rows import DERIVED, FOLLOWS
from cellc.tools.review.rules import fits

_DERIVED, _FOLLOWS = (tuple(tuple(pattern.split(" ")) for pattern in each) for each in (DERIVED, FOLLOWS))
_ADDED, _REMOVED = " added", " removed"


def follows(path: Path) -> bool:
    """Return whether a value repeats others."""
    return is_derived(path) or any(fits(pattern, path) is not None for pattern in _FOLLOWS)


def is_derived(path: Path) -> bool:
    """Return whether the compiler writes a value from others alone."""
    return any(fits(pattern, path) is not None for pattern in _DERIVED)


def spelled(names: Iterable[str]) -> set[str]:
    """Return names in the forms in which files have them: of a node full or bare, of a file with or without its end."""
    paths = [PurePosixPath(name) for name in names]
    return {form for path in paths for form in (path.as_posix(), path.as_posix().strip("/"), path.name, path.stem)}


def is_covered(following: Change, things: Sequence[Change]) -> bool:
    """Tell whether a part of the same name was added or removed with a change, which is of at least its grade."""
    end = _ADDED if following.quantity.endswith(_ADDED) else _REMOVED
    worst = [
        thing.grade
        for thing in things
        if thing.quantity.endswith(end) and spelled(thing.names) & spelled(following.names)
    ]
    return any(_is_as_bad(grade, following) for grade in worst)


def is_stated(delta: Delta, change: Change, values: Sequence[tuple[Delta, Change]], things: Sequence[Change]) -> bool:
    """Tell whether a change repeats, exactly, one of the values, or the names of parts that were added or removed."""
    said = _said(delta)
    if any(
        (_is_named_alike(stated, change) and _is_as_bad(stated.grade, change))
        or (_said(other) == said and _is_of_one(stated, delta.path))
        for other, stated in values
    ):
        return True
    gone, come = (
        {name for thing in things if thing.quantity.endswith(end) for name in spelled(thing.names)}
        for end in (_REMOVED, _ADDED)
    )
    if None in (delta.before, delta.after) and (come if delta.before is None else gone) & set(delta.path):
        return True
    was, now = (_names(leaf) for leaf in (delta.before, delta.after))
    return was != now and was - now <= gone and now - was <= come


def _is_named_alike(one: Change, other: Change) -> bool:
    return (one.subject, one.quantity) == (other.subject, other.quantity)


def _said(delta: Delta) -> tuple[Sequence[str], Sequence[str]]:
    return words(delta.before), words(delta.after)


def _names(leaf: Leaf | None) -> set[str]:
    return {word.strip("/") for word in words(leaf)}


def _is_of_one(stated: Change, path: Path) -> bool:
    return bool(spelled(stated.subject.split(" ")) & spelled(path))


def _is_as_bad(grade: Grade, change: Change) -> bool:
    return tuple(Grade).index(grade) >= tuple(Grade).index(change.grade)
