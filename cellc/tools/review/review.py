"""Two packages into a review: changes, new and resolved findings, and the gates to pass again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.compiler.deploy.gates import GateText, gate_texts
from cellc.contract.review import Review, ReviewFinding, ReviewGate, ReviewRehearsal, ReviewSide
from cellc.contract.vocabulary import ReviewArea
from cellc.tools.review.compare import changes_between
from cellc.tools.review.rules import REPEATED
from cellc.tools.review.sides import Package


def review(before: Package, after: Package, rehearsals: Sequence[ReviewRehearsal] = ()) -> Review:
    """Return what changed from one package to another, and what that means."""
    changes = changes_between(before.facts, after.facts)
    specs = before.is_spec and after.is_spec
    return Review(
        format=1,
        before=_side(before),
        after=_side(after),
        changes=changes,
        new_findings=_more(after.findings, before.findings) if specs else (),
        gone_findings=_more(before.findings, (*after.findings, *after.excused)) if specs else (),
        rehearsals=tuple(rehearsals),
        gates=gates_again(tuple(dict.fromkeys(change.area for change in changes))),
        files=tuple(
            path for path in sorted({*before.files, *after.files}) if before.files.get(path) != after.files.get(path)
        ),
        notes=(*before.notes, *after.notes),
    )


def _side(package: Package) -> ReviewSide:
    contract = package.facts.contract
    return ReviewSide(name=package.name, cell=contract.cell, configuration_id=contract.configuration_id)


def _more(one: Sequence[ReviewFinding], other: Sequence[ReviewFinding]) -> tuple[ReviewFinding, ...]:
    """Return the findings of one side that the other has not, wherever in the file they stand."""
    known = [(finding.code, finding.message) for finding in other]
    more = []
    for finding in one:
        if (finding.code, finding.message) in known:
            known.remove((finding.code, finding.message))
        else:
            more.append(finding)
    return tuple(more)


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
