"""How many changes have each area, quantity and grade, as a line says it that has no room for the changes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from cellc.contract.review import ReviewChange
from cellc.contract.vocabulary import Grade


def areas_of(changes: Sequence[ReviewChange]) -> str:
    """Return how many changes each area has, the most first."""
    counted = Counter(change.area.value for change in changes)
    return ", ".join(f"{area} {number}" for area, number in counted.most_common())


def quantities_of(changes: Sequence[ReviewChange]) -> str:
    """Return how many changes each quantity has, the most first."""
    counted = Counter(change.quantity for change in changes)
    return ", ".join(f"{quantity}{f' {number}' if number > 1 else ''}" for quantity, number in counted.most_common())


def grades_of(changes: Sequence[ReviewChange]) -> Iterator[str]:
    """Yield how many changes have each grade, the worst first."""
    for grade in reversed(Grade):
        number = sum(change.grade is grade for change in changes)
        if number:
            yield f"{number} {grade}"
