"""Steps of the bring-up by what they do: one that only has another name is the same step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from cellc.tools.review.leaves import Leaf, Leaves, Path

_STEP = "step"
OBSERVED = "observed"
"""Request of a step for controllers that claim nothing, which move no hardware."""
_DOES = ("phase", "proof", "request", OBSERVED, "effect")
"""What tells a step from others; its computer, its time and what comes before it may change."""
_ALIKE = 0.6
"""Share of equal values from which a step that was removed and one that was added are one."""
_AFTER = "after"
CALLED = "called"
"""Value of a step that is its name, where what it does is its identity."""

_Steps: TypeAlias = Mapping[str, Mapping[Path, Leaf]]


def with_step_names(before: Leaves, after: Leaves) -> Leaves:
    """Return the values before with the names that the same steps have after the change."""
    names = {
        (target, old): new
        for target in dict.fromkeys(path[1] for path in before if path[0] == _STEP)
        for old, new in _renamed(_steps(before, target), _steps(after, target)).items()
    }
    return {_path(path, names): _leaf(path, leaf, names) for path, leaf in before.items()} if names else before


def _path(path: Path, names: Mapping[tuple[str, str], str]) -> Path:
    new = names.get((path[1], path[2])) if path[0] == _STEP else None
    return path if new is None else (*path[:2], new, *path[3:])


def _leaf(path: Path, leaf: Leaf, names: Mapping[tuple[str, str], str]) -> Leaf:
    if path[0] != _STEP or path[3:] != (_AFTER,) or not isinstance(leaf, tuple):
        return leaf
    return tuple(sorted(names.get((path[1], str(name)), str(name)) for name in leaf))


def _steps(leaves: Leaves, target: str) -> _Steps:
    steps: dict[str, dict[Path, Leaf]] = {}
    for path, leaf in leaves.items():
        if path[:2] == (_STEP, target):
            steps.setdefault(path[2], {}).update({path[3:]: leaf} if path[3] in _DOES else {})
    return steps


def _renamed(before: _Steps, after: _Steps) -> dict[str, str]:
    """Return the new name of each step that is there under another one, the likeliest first."""
    scored = [
        (_likeness(was, now), old, new)
        for old, was in before.items()
        for new, now in after.items()
        if old not in after and new not in before
    ]
    names = dict[str, str]()
    for likeness, old, new in sorted(scored, key=lambda pair: -pair[0]):
        if likeness >= _ALIKE and old not in names and new not in names.values():
            names[old] = new
    return names


def _likeness(before: Mapping[Path, Leaf], after: Mapping[Path, Leaf]) -> float:
    """Return the share of equal values; of steps that ask for another kind of thing, none."""
    kind = ("request", "kind")
    if before.get(kind) != after.get(kind):
        return 0.0
    paths = {*before, *after}
    return sum(_equal(before.get(path), after.get(path)) for path in paths) / max(len(paths), 1)


def _equal(one: Leaf | None, other: Leaf | None) -> float:
    if isinstance(one, tuple) and isinstance(other, tuple) and one != other:
        return len({*one} & {*other}) / len({*one} | {*other})
    return float(one == other)
