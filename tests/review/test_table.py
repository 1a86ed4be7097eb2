"""The table of the grades: complete, written down, and each rule judged by hand."""

from __future__ import annotations

import pytest

from cellc.contract.vocabulary import GateCode, Grade, ReviewArea
from cellc.tools.review.grading import grade
from cellc.tools.review.leaves import Delta, Leaf
from cellc.tools.review.rows import ROWS
from cellc.tools.review.rules import APPROVAL, REPEATED, THINGS, Rule
from cellc.tools.review.sides import Package
from tests.docs import review

_D, _R, _S = Grade.DANGEROUS, Grade.REVIEW, Grade.SAFE


def test_page_of_the_grades_is_their_table() -> None:
    # Written by `python -m tests.docs.review`.
    assert review.PAGE.read_text(encoding="utf-8") == review.page()


def test_no_two_rows_have_one_pattern() -> None:
    for table in ([row.pattern for row in ROWS], [thing.pattern for thing in THINGS]):
        assert len(table) == len(set(table))


def test_every_area_has_an_approval_and_its_gates() -> None:
    assert set(APPROVAL) == set(REPEATED) == set(ReviewArea)


def test_the_first_gate_of_an_area_is_the_one_that_looks_at_it() -> None:
    # By the tables of gates and layers: G1 is axis, limit, TCP, collision, frame; G5 area, stop, observer, tool load;
    # L1 the cable and the address, L5 offset, transform age and authority, L6 owner, cancel and tolerance.
    assert REPEATED[ReviewArea.FRAMES] == (GateCode.G1, GateCode.L5)
    assert REPEATED[ReviewArea.LIMITS] == (GateCode.G1,)
    assert REPEATED[ReviewArea.PAYLOAD] == REPEATED[ReviewArea.SAFETY] == (GateCode.G5,)
    assert REPEATED[ReviewArea.CONTROL] == (GateCode.G2, GateCode.L6)
    assert REPEATED[ReviewArea.NETWORK] == (GateCode.G3, GateCode.L1)


@pytest.mark.parametrize(
    ("rule", "before", "after", "expected"),
    [
        (Rule.MORE, 1.0, 2.0, _D),
        (Rule.MORE, 2.0, 1.0, _S),
        (Rule.MORE, 2.0, None, _D),
        (Rule.MORE, None, 2.0, _S),
        (Rule.LESS, 2.0, 1.0, _D),
        (Rule.LESS, -2.0, -1.0, _S),
        (Rule.LOOSER, 0.1, 0.2, _D),
        (Rule.LOOSER, 0.1, None, _D),
        (Rule.LOOSER, 0.1, 0.0, _D),
        (Rule.LOOSER, 0.0, 0.1, _R),
        (Rule.LOOSER, None, 0.1, _R),
        (Rule.LOOSER, 0.2, 0.1, _R),
        (Rule.LOOSER, "a", "b", _D),
        (Rule.BACK, 3, 2, _D),
        (Rule.BACK, 3, 4, _R),
        (Rule.NAMED, "controls", "UNKNOWN", _D),
        (Rule.NAMED, "controls", "robot", _R),
        (Rule.NAMED, "controls", None, _D),
        (Rule.NAMED, "UNKNOWN", "controls", _R),
        (Rule.MATRIX, "OK: known", "UNKNOWN: new", _D),
        (Rule.MATRIX, "UNKNOWN: new", "OK: known", _S),
        (Rule.MATRIX, "OK: known", "OK: newer", _R),
        (Rule.CLAIM, "one", "other", _D),
        (Rule.CLAIM, "one", None, _R),
        (Rule.LOST, ("a", "b"), ("a",), _D),
        (Rule.LOST, ("a",), ("a", "b"), _R),
        (Rule.SAFE, 1.0, 2.0, _S),
        (Rule.REVIEW, 1.0, 2.0, _R),
        (Rule.DANGEROUS, 1.0, 2.0, _D),
    ],
)
def test_a_rule_grades(main: Package, rule: Rule, before: Leaf | None, after: Leaf | None, expected: Grade) -> None:
    assert grade(rule, Delta(("any",), before, after), main.facts, main.facts).grade is expected
