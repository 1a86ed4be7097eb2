"""Reviews of a cell of the repository against itself with edits."""

from __future__ import annotations

from functools import cache

from cellc.compiler.pipeline import check
from cellc.contract.review import Review, ReviewChange
from cellc.tools.review.compare import reported
from cellc.tools.review.facts import Facts
from cellc.tools.review.merging import merged
from cellc.tools.review.review import review
from cellc.tools.review.sides import Package, package_of
from tests.cells import spec_of
from tests.review.revisions import Edit, edited


@cache
def package_before(cell: str) -> Package:
    """Return a cell as it is."""
    return package_of("before", check(spec_of(cell)))


def review_of_text(cell: str, text: str) -> Review:
    """Return the review of a cell against another text of its spec, which has no error."""
    file = spec_of(cell).as_posix()
    checked = check(file, {file: text})
    assert checked.ok, [found.message for found in checked.diagnostics]
    return review(package_before(cell), package_of("after", checked))


def review_of(cell: str, *edits: Edit) -> Review:
    """Return the review of a cell against itself with edits."""
    return review_of_text(cell, edited(*edits, cell=cell))


def changes_between(before: Facts, after: Facts) -> tuple[ReviewChange, ...]:
    """Return every change of two packages, without what causes it."""
    return merged([(None, change) for change in reported(before, after)], before, after)
