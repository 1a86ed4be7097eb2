"""Changes that are alike as one, the worst first, each with who approves it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from cellc.contract.review import ReviewChange
from cellc.contract.vocabulary import UNKNOWN
from cellc.tools.review.change import Change
from cellc.tools.review.facts import Facts
from cellc.tools.review.order import order_of
from cellc.tools.review.rules import APPROVAL, HANDED

_RECOVERY = "recovery owner"
"""Who is responsible for what lets motion resume, beside the approver of safety."""


def merged(found: Sequence[tuple[int | None, Change]], before: Facts, after: Facts) -> tuple[ReviewChange, ...]:
    """Return changes with the numbers of their causes, the worst first, those of one cause that are alike as one."""
    owners = _approvers(before, after)
    alike: dict[tuple[int | None, Change], list[str]] = {}
    for cause, change in found:
        alike.setdefault((cause, replace(change, subject="")), []).append(change.subject)
    changes = [
        _reviewed(change, cause, tuple(dict.fromkeys(subjects)), owners) for (cause, change), subjects in alike.items()
    ]
    return tuple(sorted(changes, key=order_of))


def _approvers(before: Facts, after: Facts) -> Mapping[str, str]:
    """Return who approves: who did before the change, so that none chooses whom to ask; who is new beside them."""
    were, are = before.contract.approvals, after.contract.approvals
    return {
        area: " and ".join(
            owner for owner in dict.fromkeys((were.get(area, ""), are.get(area, ""))) if owner and owner != UNKNOWN
        )
        or were.get(area, "")
        for area in {*were, *are}
    } | {_RECOVERY: str(before.leaves.get(("spec", "safety", *_RECOVERY.split()), ""))}


def _reviewed(change: Change, cause: int | None, subjects: Sequence[str], owners: Mapping[str, str]) -> ReviewChange:
    asked, own = change.approval or APPROVAL[change.area], APPROVAL[change.area]
    owner = owners.get(asked, "")
    answers = owners[_RECOVERY] if "recover" in change.quantity else ""
    if answers and answers not in owner.split(" and "):
        owner = f"{owner} and {answers}" if owner else answers
    if change.quantity.startswith(HANDED) and change.before and change.before not in owner.split(" and "):
        owner = f"{owner} and {change.before}" if owner else change.before
    return ReviewChange(
        area=change.area,
        subjects=tuple(subjects),
        quantity=change.quantity,
        before=change.before,
        after=change.after,
        delta=change.delta,
        grade=change.grade,
        breaking=change.breaking,
        why=change.why,
        approval=asked,
        owner=owner,
        beside={area: owners.get(area, "") for area in (own, *change.asks) if area != asked},
        cause=cause,
    )
