"""Numbers in another order are another value: every value of every spec with two numbers of it exchanged.

A session takes one value of sixty; with ``--long`` every one is tried.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import combinations

import pytest

from cellc.contract.review import Review
from cellc.contract.vocabulary import Grade
from cellc.tools.review.review import review
from cellc.tools.review.sides import package_of
from cellc.tools.review.tokens import ordered, parts, tokens
from tests.cells import EVERY_CELL
from tests.review.edits import package_before
from tests.review.leaves import SpecLeaf, leaves_of, with_text
from tests.review.test_every_leaf import WITHOUT_EFFECT, names_a_fact
from tests.sample import sample

_SHARE = 60
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?![\w.:/]*[.:/]\d)")


def _reviewed(leaf: SpecLeaf, text: str) -> Review | None:
    checked = with_text(leaf, text)
    return review(package_before(leaf.cell), package_of("after", checked)) if checked.ok else None


def _exchanged(text: str) -> Iterator[tuple[str, str, str]]:
    """Yield the text with two of its numbers exchanged, and with either of them in both places."""
    for one, other in combinations(_NUMBER.finditer(text), 2):
        if float(one[0]) != float(other[0]):
            head, between, tail = text[: one.start()], text[one.end() : other.start()], text[other.end() :]
            yield (
                f"{head}{other[0]}{between}{one[0]}{tail}",
                f"{head}{other[0]}{between}{other[0]}{tail}",
                f"{head}{one[0]}{between}{one[0]}{tail}",
            )


def _worst(found: Review | None) -> int:
    return max((tuple(Grade).index(change.grade) for change in found.changes), default=-1) if found else -1


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_two_numbers_that_are_exchanged_are_a_fact_with_the_grade_of_one(
    cell: str, request: pytest.FixtureRequest
) -> None:
    wrong = dict[str, str]()
    leaves = [leaf for leaf in leaves_of(cell) if leaf.name not in WITHOUT_EFFECT]
    for leaf in sample(request, leaves, _SHARE, lambda leaf: leaf.name):
        for both, *single in _exchanged(leaf.text):
            found = _reviewed(leaf, both)
            if found is None:
                continue
            if not names_a_fact(found) or _worst(found) < max(_worst(_reviewed(leaf, text)) for text in single):
                wrong[leaf.name] = f"{leaf.text} -> {both}"
            break
    assert wrong == {}


def test_figures_of_a_line_are_compared_in_order_and_each_with_the_word_before_it() -> None:
    vector = "Payload: 0.92 kg, center of mass -5 5 46 mm"
    assert ordered(vector) != ordered(vector.replace("-5 5", "5 -5"))
    assert tokens(vector) == tokens(vector.replace("-5 5", "5 -5"))
    assert ordered(vector) == ordered("center of mass -0.005 0.005 0.046 m, Payload: 920 g")
    assert ordered("left 12 N, right 8 N") == ordered("right 8 N, left 12 N") != ordered("left 8 N, right 12 N")
    assert ordered("a 10.1.0.1, b 10.1.0.2") != ordered("a 10.1.0.2, b 10.1.0.1")
    assert [*parts("mass -0.005 0.005")] == ["-0.005", "0.005"]
