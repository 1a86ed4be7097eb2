"""Two packages into a review: changes, new and resolved findings, and the gates to pass again."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence

from cellc.compiler.deploy.gates import GateText, gate_texts
from cellc.contract.diagnostics import Severity
from cellc.contract.review import Review, ReviewChange, ReviewFinding, ReviewGate, ReviewRehearsal, ReviewSide
from cellc.contract.vocabulary import ReviewArea
from cellc.tools.review.explained import explained
from cellc.tools.review.renames import Names, Rename, names_of
from cellc.tools.review.replaced import joints_of
from cellc.tools.review.rules import REPEATED
from cellc.tools.review.sides import Package


def review(before: Package, after: Package, rehearsals: Sequence[ReviewRehearsal] = ()) -> Review:
    """Return what changed from one package to another, and what that means."""
    told = explained(before, after)
    specs = before.is_spec and after.is_spec
    return Review(
        format=1,
        before=_side(before),
        after=_side(after),
        changes=told.changes,
        causes=told.causes,
        new_findings=_more(after.findings, before.findings, told.renames) if specs else (),
        gone_findings=_more(before.findings, (*after.findings, *after.excused), told.renames) if specs else (),
        rehearsals=tuple(rehearsals),
        gates=_gates(before, after, told.changes),
        files=tuple(
            path for path in sorted({*before.files, *after.files}) if before.files.get(path) != after.files.get(path)
        ),
        notes=(*before.notes, *after.notes),
    )


def _gates(before: Package, after: Package, changes: Sequence[ReviewChange]) -> tuple[ReviewGate, ...]:
    """Return the gates to pass again: none where the configuration that evidence rests on is the same."""
    if before.facts.contract.configuration_id == after.facts.contract.configuration_id:
        return ()
    again = gates_again(tuple(dict.fromkeys(change.area for change in changes)))
    # Evidence of another configuration does not count, even where no gate looks at what changed.
    return again or gates_again((ReviewArea.GATES,))


def _side(package: Package) -> ReviewSide:
    contract = package.facts.contract
    joints = {
        device: tuple(name for name in contract.joint_limits if name in joints_of(device, package.facts))
        for device in contract.devices
    }
    return ReviewSide(name=package.name, cell=contract.cell, configuration_id=contract.configuration_id, joints=joints)


_RANK = (Severity.ERROR, Severity.BLOCKER, Severity.WARNING)
_FIGURE = re.compile(r"(?<!\w)\d[\w.:/-]*")
_GOT = re.compile(r"\bgot .*")


def _more(
    one: Sequence[ReviewFinding], other: Sequence[ReviewFinding], renames: Sequence[Rename]
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
    known = Counter(_said(finding, names) for finding in before)
    new = []
    for number, finding in enumerate(found):
        said = _said(finding, names)
        known[said] -= 1
        if known[said] < 0:
            new.append(number)
    return tuple(new)


def _said(finding: ReviewFinding, names: Names | None) -> tuple[str, str]:
    """Return what a finding says, without the figures and what it got."""
    message = finding.message if names is None else names.in_text(finding.message)
    return finding.code, _FIGURE.sub("#", _GOT.sub("", message))


def gates_again(areas: Sequence[ReviewArea]) -> tuple[ReviewGate, ...]:
    """Return the gates to pass again: the first that looks at an area that changed, and all that rest on it."""
    texts = gate_texts()
    return (*_again(texts.promotion, areas), *_again(texts.network, areas))


def _again(texts: Sequence[GateText], areas: Sequence[ReviewArea]) -> Iterator[ReviewGate]:
    repeat = False
    for text in texts:
        because = tuple(area for area in areas if text.code in REPEATED[area])
        repeat = repeat or bool(because)
        if repeat:
            yield ReviewGate(code=text.code, title=text.title, evidence=text.evidence, because=because)
