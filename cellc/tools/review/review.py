"""Two packages into a review: changes, new and resolved findings, and the gates to pass again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.compiler.deploy.gates import GateText, gate_texts
from cellc.contract.diagnostics.wording import count
from cellc.contract.review import Review, ReviewChange, ReviewFinding, ReviewGate, ReviewRehearsal, ReviewSide
from cellc.contract.vocabulary import ReviewArea
from cellc.tools.review.explained import Explained, explained
from cellc.tools.review.findings import more, new_among, said_of
from cellc.tools.review.renames import Rename
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
        new_findings=_with_causes(more(after.findings, before.findings, told.renames), told) if specs else (),
        gone_findings=more(before.findings, (*after.findings, *after.excused), told.renames) if specs else (),
        rehearsals=tuple(rehearsals),
        gates=_gates(before, after, told.changes),
        files=tuple(
            path for path in sorted({*before.files, *after.files}) if before.files.get(path) != after.files.get(path)
        ),
        notes=(*before.notes, *after.notes, *_standing(before, after, told.renames)),
    )


def _with_causes(found: Sequence[ReviewFinding], explanation: Explained) -> tuple[ReviewFinding, ...]:
    """Return findings with the number of the cause that each follows from."""
    causes = [
        next((number for number, brought in enumerate(explanation.brought) if said_of(each) in brought), None)
        for each in found
    ]
    return tuple(each.model_copy(update={"cause": cause}) for each, cause in zip(found, causes, strict=True))


def _standing(before: Package, after: Package, renames: Sequence[Rename]) -> Iterator[str]:
    """Yield how many errors there were before and still are; of a spec beside a folder, how many it has."""
    if not (before.is_spec and after.is_spec):
        for side in (before, after):
            if side.errors:
                yield f"{side.name}: {count(len(side.errors), 'error')}; `cellc check` lists them"
        return
    standing = len(after.errors) - len(new_among(after.errors, before.errors, renames))
    if standing:
        first = after.errors[0]
        yield f"{count(standing, 'error')} of before still there, such as {first.code}; `cellc check` lists them"


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
