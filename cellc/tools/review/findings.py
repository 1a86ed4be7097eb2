"""Findings of the check that one side has and the other has not."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

from cellc.contract.diagnostics import Severity
from cellc.contract.review import ReviewFinding
from cellc.tools.review.renames import Names, Rename, names_of

_RANK = (Severity.ERROR, Severity.BLOCKER, Severity.WARNING)
_FIGURE = re.compile(r"(?<!\w)\d[\w.:/-]*")
_GOT = re.compile(r"\bgot .*")


def more(
    one: Sequence[ReviewFinding], other: Sequence[ReviewFinding], renames: Sequence[Rename] = ()
) -> tuple[ReviewFinding, ...]:
    """Return the findings of one side that the other has not, those that fail first.

    A finding that says the same of another figure, or of a part that has another name, is neither new nor gone.
    """
    more = [one[number] for number in new_among(one, other, renames)]
    return tuple(sorted(more, key=lambda finding: _RANK.index(finding.severity) if finding.severity in _RANK else 9))


def new_among(
    found: Sequence[ReviewFinding], before: Sequence[ReviewFinding], renames: Sequence[Rename] = ()
) -> tuple[int, ...]:
    """Return the numbers of the findings that were not there before."""
    names = names_of(renames) if renames else None
    known = Counter(said_of(finding, names) for finding in before)
    new = []
    for number, finding in enumerate(found):
        said = said_of(finding, names)
        known[said] -= 1
        if known[said] < 0:
            new.append(number)
    return tuple(new)


def said_of(finding: ReviewFinding, names: Names | None = None) -> tuple[str, str]:
    """Return what a finding says, without the figures and what it got."""
    message = finding.message if names is None else names.in_text(finding.message)
    return finding.code, _FIGURE.sub("#", _GOT.sub("", message))
