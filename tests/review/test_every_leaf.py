"""Nothing is passed over: every scalar of every spec, changed alone to another valid value, is a fact with a name.

A session takes one leaf of a hundred and twenty, others in each cell; with ``--long`` every leaf is tried.
"""

from __future__ import annotations

import pytest

from cellc.contract.review import Review
from cellc.contract.vocabulary import Grade
from cellc.tools.review.review import review
from cellc.tools.review.short import MOST_LINES, render_short
from cellc.tools.review.sides import package_of
from tests.cells import EVERY_CELL
from tests.review.edits import package_before
from tests.review.leaves import changed, leaves_of
from tests.sample import sample

_SHARE = 120
WITHOUT_EFFECT: dict[str, str] = {
    "gen3_2f: motion.groups.manipulator.base": "`arm/base` and `arm/base_link` are two names of one link",
}
"""Leaves whose other text reaches nothing, and why: no evidence, no file and no person at the cell depends on it."""


def names_a_fact(found: Review) -> bool:
    """Whether a change has a name of its own, and is not a line of a file or a value that no file shows."""
    return any(
        "(not classified)" not in change.quantity and "that no file of the package shows" not in change.quantity
        for change in found.changes
    )


def _contradicts(found: Review) -> bool:
    """Whether gates are to be repeated under the same configuration, or none under another."""
    return (found.before.configuration_id == found.after.configuration_id) is bool(found.gates)


_NO_EVIDENCE = ("owners", "documents")
_NAMES = ("owner of ", "approver of ", "excuse of ", "name of ")


def _asks_without_evidence(found: Review) -> list[str]:
    """Return what somebody must approve that is neither an owner, a name, an excuse nor a document.

    Of one configuration all evidence still counts: nothing that evidence rests on may have changed.
    """
    if found.before.configuration_id != found.after.configuration_id:
        return []
    return [
        change.quantity
        for change in found.changes
        if change.grade is not Grade.SAFE and change.area not in _NO_EVIDENCE and not change.quantity.startswith(_NAMES)
    ]


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_a_leaf_that_changed_is_a_fact_with_a_name(cell: str, request: pytest.FixtureRequest) -> None:
    taken = sample(request, leaves_of(cell), _SHARE, lambda leaf: leaf.name)
    silent, contradicting, long, tried = dict[str, str](), list[str](), list[str](), 0
    unreasoned = list[str]()
    for leaf in taken:
        other = changed(leaf)
        if other is None or leaf.name in WITHOUT_EFFECT:
            continue
        text, checked = other
        tried += 1
        found = review(package_before(cell), package_of("after", checked))
        if not names_a_fact(found):
            silent[leaf.name] = f"{leaf.text} -> {text}"
        contradicting += [leaf.name] if _contradicts(found) or _asks_without_evidence(found) else []
        unreasoned += [leaf.name for change in found.changes if change.grade is Grade.DANGEROUS and not change.why][:1]
        long += [leaf.name] if len(list(render_short(found))) > MOST_LINES else []
    assert (silent, contradicting, long, unreasoned) == ({}, [], [], [])
    assert tried > 0.5 * len(taken) or len(taken) < 40
