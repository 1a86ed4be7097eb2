"""Changes under what causes them: the worst first, then by who approves; with the figures that say the most."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cellc.contract.review import ApprovalArea, Review, ReviewCause, ReviewChange
from cellc.contract.vocabulary import Grade

_ASKED: Sequence[ApprovalArea] = ("safety", "vendor", "controller", "time_tf", "network", "graph", "data")
_TELLING = ("reach", "largest payload", "base in its parent", "tip", "pose in its parent", "place in the root frame")
"""Quantities that say the most about a cause with many changes, in this order."""
_SAID, _HOME = 3, "home"
NAME_OF = "name of the "
"""How the quantity of another name begins."""


@dataclass(frozen=True, slots=True)
class Group:
    """What one cause changes; of changes without a cause, such as those of folders, all of one area.

    Attributes:
        changes: the worst first; never empty.
    """

    cause: ReviewCause | None
    changes: tuple[ReviewChange, ...]

    @property
    def grade(self) -> Grade:
        """The worst grade of a change in it."""
        return self.changes[0].grade

    @property
    def title(self) -> str:
        """The line of the spec, with its values and its place, or the area."""
        return self._title("" if self.cause is None else self.cause.line)

    def fitting(self, width: int) -> str:
        """Return the title with as much of the path at its end as there is room for."""
        parts = [] if self.cause is None else self.cause.line.split(".")
        while len(parts) > 2 and len(self._title("." * 3 + ".".join(parts))) > width:
            parts = parts[1:]
        is_whole = self.cause is None or len(parts) == len(self.cause.line.split("."))
        return self.title if is_whole else self._title("..." + ".".join(parts))

    def _title(self, line: str) -> str:
        cause = self.cause
        if cause is None:
            return self.changes[0].area.value
        if cause.renamed:
            follow = next((change.delta for change in self.changes if change.quantity.startswith(NAME_OF)), "")
            return f"renamed: {cause.before} -> {cause.after}{f' ({follow})' if follow else ''}"
        place = cause.place.replace("\\", "/").rpartition("/")[2]
        file, _, rest = place.partition(":")
        where = f"{file}:{rest.partition(':')[0]}" if rest else place
        if cause.lines > 1:
            return f"{line} ({where}): {cause.after}"
        if cause.before is None or cause.after is None:
            return f"{line} {'added' if cause.before is None else 'removed'} ({where})"
        return f"{line}: {cause.before} -> {cause.after} ({where})"

    @property
    def figures(self) -> tuple[str, ...]:
        """How far the most telling of its quantities changed, where it has several changes."""
        if len(self.changes) < 2:
            return ()
        sized = [change for change in self.changes if change.delta and change.quantity in _TELLING]
        listed = dict[str, None]()
        for change in sorted(
            sized, key=lambda change: (_TELLING.index(change.quantity), _HOME not in change.subjects[0])
        ):
            listed[_figure(change)] = None
        return tuple(listed)[:_SAID]

    @property
    def asks(self) -> str:
        """Who approves it: area and owner of each change that is not safe."""
        asked = {change.approval: change.owner for change in self.changes if change.grade is not Grade.SAFE}
        return ", ".join(f"{area} ({asked[area] or 'no owner'})" for area in _ASKED if area in asked)


def _figure(change: ReviewChange) -> str:
    if change.quantity == "tip":
        return f"tip in {change.subjects[0].partition(' in ')[2]} {change.delta}"
    return f"{change.quantity if change.quantity in _TELLING[:2] else change.subjects[0]} {change.delta}"


def groups_of(review: Review) -> tuple[Group, ...]:
    """Return the changes of a review under their causes."""
    held: dict[tuple[int, str], list[ReviewChange]] = {}
    for change in review.changes:
        key = (-1, change.area.value) if change.cause is None else (change.cause, "")
        held.setdefault(key, []).append(change)
    groups = [
        Group(None if number < 0 else review.causes[number], tuple(changes)) for (number, _), changes in held.items()
    ]
    return tuple(sorted(groups, key=_order))


def _order(group: Group) -> tuple[int, int]:
    worst = [change.approval for change in group.changes if change.grade is group.grade]
    return -tuple(Grade).index(group.grade), min(map(_ASKED.index, worst))


def areas_of(changes: Sequence[ReviewChange]) -> str:
    """Return how many changes each area has, the most first."""
    counted = Counter(change.area.value for change in changes)
    return ", ".join(f"{area} {number}" for area, number in counted.most_common())


def grades_of(changes: Sequence[ReviewChange]) -> Iterator[str]:
    """Yield how many changes have each grade, the worst first."""
    for grade in reversed(Grade):
        number = sum(change.grade is grade for change in changes)
        if number:
            yield f"{number} {grade}"
