"""The matrix of a campaign for people: fault by step, each with the outcome that it led to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.contract.rehearsals import RehearsalEntry, StepEntry
from cellc.mock.campaign.run import RunEnd

SHORT = {
    "succeeded": "ok",
    "cancelled": "cancel",
    "stale_state": "stale",
    "tf_failure": "tf",
    "planning_failure": "plan",
    "goal_rejection": "reject",
    "tolerance_violation": "toler",
    "missed_cycle": "missed",
    "protective_stop": "stop",
    "emergency_stop": "estop",
    "hardware_fault": "hardware",
    "wrong_owner": "owner",
    "timeout": "time",
}
"""Outcomes as the matrix has them; one that is not here stands in full."""


def matrix_lines(entry: RehearsalEntry, ends: Sequence[RunEnd]) -> Iterator[str]:
    """Yield the matrix of a rehearsal's runs with one fault; a run that failed has an exclamation mark."""
    cells: dict[str, dict[int, list[str]]] = {}
    for end in ends:
        if len(end.run.hits) == 1 and end.run.rehearsal == entry.name:
            hit = end.run.hits[0]
            cells.setdefault(hit.fault, {}).setdefault(hit.step, []).append(_label(end))
    rows = {fault: [_joined(steps.get(number, [])) for number in _numbers(entry)] for fault, steps in cells.items()}
    widths = [max([len(str(number)), *(len(row[number - 1]) for row in rows.values())]) for number in _numbers(entry)]
    name_width = max([len("fault"), *(len(fault) for fault in rows)])
    yield f"{entry.name}: {', '.join(f'{number} {_title(step)}' for number, step in enumerate(entry.steps, start=1))}"
    yield "  ".join(["fault".ljust(name_width), *_padded([str(number) for number in _numbers(entry)], widths)]).rstrip()
    for fault, row in rows.items():
        yield "  ".join([fault.ljust(name_width), *_padded(row, widths)]).rstrip()


def legend(ends: Sequence[RunEnd]) -> str:
    """Return what the short outcomes of some runs stand for."""
    used = {end.result.outcome for end in ends}
    pairs = [f"{short} {outcome}" for outcome, short in SHORT.items() if outcome in used and short != outcome]
    return f"a/b: at the start of the step / as its joints begin to move; {', '.join(pairs)}"


def _numbers(entry: RehearsalEntry) -> range:
    return range(1, len(entry.steps) + 1)


def _title(step: StepEntry) -> str:
    return " ".join(word for word in (step.kind, step.command or "", step.target) if word)


def _label(end: RunEnd) -> str:
    label = SHORT.get(end.result.outcome, end.result.outcome)
    return label if end.passed else f"{label}!"


def _joined(labels: Sequence[str]) -> str:
    return labels[0] if len(set(labels)) == 1 else "/".join(labels)


def _padded(texts: Sequence[str], widths: Sequence[int]) -> list[str]:
    return [text.ljust(width) for text, width in zip(texts, widths, strict=True)]
