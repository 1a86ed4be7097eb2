"""What integrators change in one pull request, with the grade that they expect by the definitions of docs/review.md."""

from __future__ import annotations

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.review import Review
from cellc.contract.vocabulary import Grade
from cellc.tools.review.leaves import Leaves
from cellc.tools.review.review import review
from cellc.tools.review.sides import package_of
from cellc.tools.review.steps import with_step_names
from tests.cells import spec_of
from tests.review.edits import package_before, review_of
from tests.review.revisions import Edit, edited

_TO_CONTROL: tuple[Edit, ...] = (
    ("move_group, host: planner_pc", "move_group, host: control_pc"),
    ("tray_to_press, host: planner_pc", "tray_to_press, host: control_pc"),
)


def _both_ways(cell: str, *edits: Edit) -> tuple[Review, Review]:
    """Return the review of edits, and that of taking them back."""
    file = spec_of(cell).as_posix()
    other = package_of("edited", check(file, {file: edited(*edits, cell=cell)}))
    return review(package_before(cell), other), review(other, package_before(cell))


@pytest.mark.parametrize("moved", [_TO_CONTROL[:1], _TO_CONTROL])
def test_nodes_on_another_computer_are_compared_there(moved: tuple[Edit, ...]) -> None:
    there, back = _both_ways("fr3_hand", *moved)
    assert (there.worst(), back.worst()) == (Grade.REVIEW, Grade.REVIEW)
    assert not [change for change in (*there.changes, *back.changes) if "unnoticed" in change.why]


def test_a_version_that_no_computer_compares_any_more_is_dangerous() -> None:
    pinned, unknown = "moveit: 2.5.9", "moveit: UNKNOWN"
    found = review_of("fr3_hand", (pinned, unknown))
    assert [change.grade for change in found.changes if change.quantity == "versions that it compares"] == [
        Grade.DANGEROUS
    ]


def test_steps_with_no_proof_and_no_effect_are_equal_in_both() -> None:
    def comparing(name: str, *parts: str) -> Leaves:
        step = ("step", "real", name)
        return {(*step, "proof"): (), (*step, "effect"): (), (*step, "request", "parts"): parts}

    after = comparing("compare_versions", "os", "moveit")
    assert with_step_names(comparing("compare_versions_on_control_pc", "os"), after).keys() == after.keys()
