"""Structured data as leaves: each value by its path, whatever order, comments or spelling it was written in."""

from __future__ import annotations

import datetime
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias, Union

from cellc.compiler.cell.members import field_names
from cellc.contract.base import Json
from cellc.contract.diagnostics import Span
from cellc.contract.transforms import Pose, apart
from cellc.tools.review.tokens import ordered as ordered_tokens
from cellc.tools.review.tokens import tokens

Path: TypeAlias = tuple[str, ...]
Item: TypeAlias = Union[str, float, int, bool]
Value: TypeAlias = Union[Item, Pose, tuple[Item, ...]]

_NAMES = ("name", "node", "group")
"""Keys that tell entries of a list apart."""
_RELATIVE, _ABSOLUTE = 1e-9, 1e-12
"""What rounding makes of one quantity that is written in two units."""


@dataclass(frozen=True, slots=True)
class Prose:
    """A sentence with quantities: the same in other units is the same."""

    text: str

    def __str__(self) -> str:
        return self.text


Leaf: TypeAlias = Union[Value, Prose]
Leaves: TypeAlias = Mapping[Path, Leaf]


def flatten(value: Json, path: Path = ()) -> Iterator[tuple[Path, Leaf]]:
    """Yield every leaf of JSON-like data; null is as good as absent, and an entry with a name is under it."""
    if value is None:
        return
    if isinstance(value, dict):
        pose = _pose(value)
        if pose is not None:
            yield path, pose
            return
        for key, inner in value.items():
            yield from flatten(inner, (*path, key))
    elif isinstance(value, list):
        yield from _of_list(value, path)
    else:
        yield path, value


def _of_list(value: list[Json], path: Path) -> Iterator[tuple[Path, Leaf]]:
    for key in _NAMES:
        names = [entry.get(key) for entry in value if isinstance(entry, dict)]
        if value and len(names) == len(value) == len({str(name) for name in names}) and None not in names:
            for name, entry in zip(names, value, strict=True):
                rest = {inner: each for inner, each in entry.items() if inner != key} if isinstance(entry, dict) else {}
                yield from flatten(rest, (*path, str(name)))
            return
    yield path, tuple(entry if isinstance(entry, (str, int, float)) else said(entry) for entry in value)


def _pose(value: Mapping[str, Json]) -> Pose | None:
    turn = value.get("quaternion")
    place = value.get("xyz", value.get("position"))
    if len(value) != 2 or not isinstance(turn, list) or not isinstance(place, list):
        return None
    if len(place) != 3 or len(turn) != 4 or not all(isinstance(item, (int, float)) for item in (*place, *turn)):
        return None
    x, y, z = (float(item) for item in place if isinstance(item, (int, float)))
    qx, qy, qz, qw = (float(item) for item in turn if isinstance(item, (int, float)))
    return Pose((x, y, z), (qx, qy, qz, qw))


_KINDS = {"alone": "only"}
"""Kinds of proofs whose word in the file does not read as a sentence: ``only nodes /a, /b``."""


def said(entry: Json) -> str:
    """Return an entry of a list in words: its values, and the keys of those that are no text."""
    if isinstance(entry, dict):
        return " ".join(
            _KINDS.get(inner, inner) if isinstance(inner, str) else f"{key} {said(inner)}"
            for key, inner in entry.items()
            if inner not in (None, "", [])
        )
    if isinstance(entry, (list, tuple)):
        return ", ".join(said(inner) for inner in entry)
    return f"{entry:.9g}" if isinstance(entry, float) else str(entry)


def as_json(value: object) -> Json:
    """Return a value of frozen dataclasses as JSON-like data, without its places in files."""
    if isinstance(value, Span):
        return None
    if names := field_names(value):
        return {name: as_json(getattr(value, name)) for name in names}
    if isinstance(value, Mapping):
        return {str(key): as_json(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [as_json(inner) for inner in value]
    if isinstance(value, datetime.date):
        return value.isoformat()
    return value if isinstance(value, (str, int, float, bool)) else None


def same(before: Leaf, after: Leaf, *, ordered: bool = True) -> bool:
    """Tell whether two values are one value, but for rounding and, where it says nothing, the order of words."""
    if isinstance(before, Prose) and isinstance(after, Prose):
        return ordered_tokens(before.text) == ordered_tokens(after.text)
    if isinstance(before, Pose) and isinstance(after, Pose):
        return _same_pose(before, after)
    if isinstance(before, tuple) and isinstance(after, tuple):
        if not ordered and all(isinstance(item, str) for item in (*before, *after)):
            return Counter(before) == Counter(after)
        return len(before) == len(after) and all(map(_same_item, before, after))
    if isinstance(before, (str, float, int)) and isinstance(after, (str, float, int)):
        return _same_item(before, after)
    return False


def _same_item(before: Item, after: Item) -> bool:
    if isinstance(before, (bool, str)) or isinstance(after, (bool, str)):
        return before is after or (before == after and isinstance(before, bool) == isinstance(after, bool))
    return math.isclose(before, after, rel_tol=_RELATIVE, abs_tol=_ABSOLUTE)


def _same_pose(before: Pose, after: Pose) -> bool:
    meters, radians = apart(before, after)
    return meters <= 1e-9 and radians <= 1e-7


@dataclass(frozen=True, slots=True)
class Delta:
    """One leaf that differs; None where a side has none."""

    path: Path
    before: Leaf | None
    after: Leaf | None


_NOTHING: frozenset[object] = frozenset((None, (), ""))
"""What says nothing: a list that is empty is as good as one that is not there."""


def differences(before: Leaves, after: Leaves) -> tuple[Delta, ...]:
    """Return the leaves that differ, in the order of paths."""
    deltas = (Delta(path, before.get(path), after.get(path)) for path in sorted({*before, *after}))
    deltas = (delta for delta in deltas if not {delta.before, delta.after} <= _NOTHING)
    return tuple(
        delta for delta in deltas if delta.before is None or delta.after is None or not same(delta.before, delta.after)
    )


def prefixes(leaves: Leaves) -> frozenset[Path]:
    """Return every path that leads to a leaf."""
    return frozenset(path[:length] for path in leaves for length in range(1, len(path) + 1))


def words(leaf: Leaf | None) -> Sequence[str]:
    """Return the words and figures of a leaf, as other files of the package may repeat them."""
    if leaf is None:
        return ()
    if isinstance(leaf, Pose):
        return [word for number in (*leaf.position, *leaf.rpy(), *leaf.quaternion) for word in tokens(f"{number:.12f}")]
    if isinstance(leaf, tuple):
        return [word for item in leaf for word in tokens(_whole(item))]
    return list(tokens(_whole(leaf) if isinstance(leaf, (str, int, float)) else leaf.text))


def _whole(item: Item) -> str:
    """Return an entry with all of its digits: what is rounded twice is another figure than what is rounded once."""
    return f"{item:.15g}" if isinstance(item, float) else said(item)
