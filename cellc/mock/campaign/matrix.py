"""The matrix of a campaign: fault by step, each with the outcome that it led to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

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


@dataclass(frozen=True, slots=True)
class Matrix:
    """The runs of one rehearsal with one fault each.

    Attributes:
        steps: titles of the steps, in order.
        rows: fault, and for each step the runs whose fault begins with it.
    """

    rehearsal: str
    steps: tuple[str, ...]
    rows: tuple[tuple[str, tuple[tuple[RunEnd, ...], ...]], ...]


def matrix_of(entry: RehearsalEntry, ends: Sequence[RunEnd]) -> Matrix:
    """Return the matrix of a rehearsal from the runs of its campaign."""
    cells: dict[str, list[list[RunEnd]]] = {}
    for end in ends:
        if len(end.run.hits) == 1 and end.run.rehearsal == entry.name:
            hit = end.run.hits[0]
            cells.setdefault(hit.fault, [[] for _ in entry.steps])[hit.step - 1].append(end)
    rows = tuple((fault, tuple(tuple(cell) for cell in row)) for fault, row in cells.items())
    return Matrix(entry.name, tuple(_title(step) for step in entry.steps), rows)


def matrix_lines(matrix: Matrix) -> Iterator[str]:
    """Yield a matrix for a terminal; a run that failed has an exclamation mark."""
    numbers = [str(number) for number in range(1, len(matrix.steps) + 1)]
    rows = [(fault, [cell_text(cell) for cell in row]) for fault, row in matrix.rows]
    widths = [max([len(number), *(len(row[place]) for _, row in rows)]) for place, number in enumerate(numbers)]
    name_width = max([len("fault"), *(len(fault) for fault, _ in rows)])
    steps = ", ".join(f"{number} {title}" for number, title in zip(numbers, matrix.steps, strict=True))
    yield f"{matrix.rehearsal}: {steps}"
    for name, row in (("fault", numbers), *rows):
        yield "  ".join([name.ljust(name_width), *_padded(row, widths)]).rstrip()


def cell_text(ends: Sequence[RunEnd]) -> str:
    """Return the short outcomes of the runs of one fault at one step, once where they are the same."""
    labels = [_label(end) for end in ends]
    return labels[0] if len(set(labels)) == 1 else "/".join(labels)


def legend(ends: Sequence[RunEnd]) -> str:
    """Return what the short outcomes of some runs stand for."""
    used = {end.result.outcome for end in ends}
    pairs = [f"{short} {outcome}" for outcome, short in SHORT.items() if outcome in used and short != outcome]
    return f"a/b: at the start of the step / as its joints begin to move; {', '.join(pairs)}"


def _title(step: StepEntry) -> str:
    return " ".join(word for word in (step.kind, step.command or "", step.target) if word)


def _label(end: RunEnd) -> str:
    label = SHORT.get(end.result.outcome, end.result.outcome)
    return label if end.passed else f"{label}!"


def _padded(texts: Sequence[str], widths: Sequence[int]) -> list[str]:
    return [text.ljust(width) for text, width in zip(texts, widths, strict=True)]
