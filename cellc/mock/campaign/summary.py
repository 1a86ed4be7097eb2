"""A campaign as a matrix of fault by step, as lines for a terminal, and as JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict

from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.diagnostics.wording import aligned
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import RehearsalEntry, StepEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.campaign.campaign import Campaign
from cellc.mock.campaign.limits import CommandStep, LimitsReport
from cellc.mock.campaign.plan import RunEnd
from cellc.mock.result import RunOutcome

SHORT: dict[RunOutcome, str] = {
    AttemptOutcome.SUCCEEDED: "ok",
    AttemptOutcome.CANCELED: "cancel",
    AttemptOutcome.STALE_STATE: "stale",
    AttemptOutcome.TF_FAILURE: "tf",
    AttemptOutcome.PLANNING_FAILURE: "plan",
    AttemptOutcome.GOAL_REJECTION: "reject",
    AttemptOutcome.TOLERANCE_VIOLATION: "toler",
    AttemptOutcome.MISSED_CYCLE: "missed",
    AttemptOutcome.PROTECTIVE_STOP: "stop",
    AttemptOutcome.EMERGENCY_STOP: "estop",
    AttemptOutcome.HARDWARE_FAULT: "hardware",
    AttemptOutcome.WRONG_OWNER: "owner",
    AttemptOutcome.CLAIM_FAILURE: "claim",
    AttemptOutcome.UNCOMMANDED_MOTION: "MOVED",
    AttemptOutcome.TIMEOUT: "time",
}
"""Outcomes as the matrix abbreviates them; others are written in full."""

_STEPS = {
    "hold": "the command goes to where the joint is measured",
    "deceleration": "a stop begins where the joint is measured",
    "replaced": "a trajectory takes over from one that was moving",
    "off_command": "a trajectory starts where the joint is measured, not where it was commanded",
    "scaling": "the speed scaling changed",
}


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


def matrix_lines(matrix: Matrix, wide: int = 0) -> Iterator[str]:
    """Yield a matrix for a terminal; a run that failed has an exclamation mark.

    Args:
        wide: columns of the terminal, zero for a file; steps that do not fit follow in a table of their own.
    """
    numbers = [str(number) for number in range(1, len(matrix.steps) + 1)]
    rows = ((fault, *map(cell_text, row)) for fault, row in matrix.rows)
    steps = ", ".join(f"{number} {title}" for number, title in zip(numbers, matrix.steps, strict=True))
    yield f"{matrix.rehearsal}: {steps}"
    for block in _blocks([("fault", *numbers), *rows], wide):
        yield from aligned(block, wide)


def _blocks(rows: Sequence[Sequence[str]], wide: int) -> Iterator[list[tuple[str, ...]]]:
    """Yield a table as tables of as many columns as fit below the names of their rows."""
    widths = [max(map(len, column)) + 2 for column in zip(*rows, strict=True)]
    steps = range(1, len(widths))
    fits = not wide or sum(widths) - 2 <= wide
    at_once = max(1, len(steps) if fits else (wide - 2) // max(widths[1:]))
    for first in steps[::at_once]:
        yield [(row[0], *row[first : first + at_once]) for row in rows]


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


ReplayCommand = Callable[[str], str]
"""Returns the command line that runs one run again, by its identifier."""


def campaign_lines(campaign: Campaign, replay: ReplayCommand, wide: int = 0) -> Iterator[str]:
    """Yield the matrix of each rehearsal, pairs, outcomes with their bounds, limits, and what failed.

    Args:
        wide: columns of the terminal, zero for a file.
    """
    for baseline in campaign.baselines:
        yield from matrix_lines(matrix_of(baseline.run.entry, campaign.ends), wide)
        yield ""
    if campaign.ends:
        yield legend(campaign.ends)
        yield ""
    yield from outcome_lines(campaign.ends)
    yield from limit_lines(campaign.limits)
    for end in campaign.failed:
        yield from failure_lines(end, replay(end.run.identifier))
    total, failed = len(campaign.all_ends), len(campaign.failed)
    verdict = "passed" if campaign.passed else "FAILED"
    of = ", of an edited folder" if any(end.result.edited for end in campaign.all_ends) else ""
    yield f"{verdict}: {total - failed} of {total} runs ended in a named outcome within bounds and limits{of}"


def _of(end: RunEnd) -> str:
    return f"{end.run.identifier} of an edited folder" if end.result.edited else end.run.identifier


def end_lines(end: RunEnd, command: str) -> Iterator[str]:
    """Yield how one run ended that was run alone."""
    result, run = end.result, end.run
    if not end.passed:
        yield from failure_lines(end, command)
        yield f"        digest: {end.digest}"
        return
    yield f"passed  {_of(end)}: {result.outcome} (named: {', '.join(run.outcomes)})"
    if run.within_s is not None and result.response_s is not None and result.outcome != AttemptOutcome.SUCCEEDED:
        yield f"        bound: {result.response_s * 1e3:.0f} ms of {run.within_s * 1e3:.0f} ms"
    if result.reason:
        yield f"        reason: {result.reason}"
    yield f"        digest: {end.digest}"


def failure_lines(end: RunEnd, command: str) -> Iterator[str]:
    """Yield why a run failed, and how to run it again."""
    result, run = end.result, end.run
    yield f"FAILED  {_of(end)}: {result.outcome}"
    if not end.named:
        yield f"        expected: {' or '.join(run.outcomes)}"
    elif not end.in_time and run.within_s is not None:
        took = "none" if result.response_s is None else f"{result.response_s * 1e3:.0f} ms"
        yield f"        bound: response {took}, allowed {run.within_s * 1e3:.0f} ms"
    for excess in end.limits.excesses:
        yield f"        limit: {excess}"
    for violation in result.violations:
        yield f"        against the contract: {violation}"
    if text := end.crash or result.reason:
        yield f"        reason: {text}"
    yield f"        replay: {command}"


def limit_lines(limits: LimitsReport) -> Iterator[str]:
    """Yield the largest shares of limits that commands reached, and their steps."""
    peaks = ", ".join(f"{peak.quantity} {peak.share:.1%}" for peak in limits.peaks)
    held = "held by every commanded trajectory" if limits.held else f"EXCEEDED {len(limits.excesses)} times"
    yield f"limits: {held}; largest share: {peaks or 'nothing was commanded'}"
    for cause in sorted({step.cause for step in limits.steps}):
        steps = [step for step in limits.steps if step.cause == cause]
        largest = max(steps, key=_size)
        yield (
            f"        {len(steps)} x {cause}, where the real controller steps too: {_STEPS.get(cause, cause)}; "
            f"at most {_size(largest):.4f} rad or m (`{largest.joint}`)"
        )
    if limits.held_outside:
        count, first = len(limits.held_outside), limits.held_outside[0]
        yield f"        {count} x hold of a position that was measured outside its limit: {first}"
    joints = sorted({name.partition("/")[0] for name in limits.unchecked})
    if joints:
        yield f"        set points, whose speed is the device's own and UNKNOWN here: {', '.join(joints)}"


def outcome_lines(ends: Sequence[RunEnd]) -> Iterator[str]:
    """Yield the number of runs with each outcome, and the run nearest to its bound."""
    for outcome in sorted({end.result.outcome for end in ends}):
        these = [end for end in ends if end.result.outcome == outcome]
        bounded = [(_share(end), end) for end in these if outcome != AttemptOutcome.SUCCEEDED and end.run.within_s]
        line = f"{outcome}: {len(these)} runs"
        if bounded:
            slowest = max(bounded, key=lambda entry: entry[0])[1]
            took_s, within_s = slowest.result.response_s or 0.0, slowest.run.within_s or 0.0
            line += f", slowest {took_s * 1e3:.0f} of {within_s * 1e3:.0f} ms ({slowest.run.identifier})"
        yield line


def _share(end: RunEnd) -> float:
    return (end.result.response_s or 0.0) / end.run.within_s if end.run.within_s else 0.0


def _size(step: CommandStep) -> float:
    return abs(step.step)


def campaign_json(campaign: Campaign, notes: Sequence[str], replay: ReplayCommand) -> str:
    """Return the campaign as JSON: every run with its outcome, bound, limits and digest."""
    content = {
        "configuration_id": campaign.configuration_id,
        "seed": campaign.seed,
        "passed": campaign.passed,
        "runs": [_run(end, replay) for end in campaign.all_ends],
        "limits": _limits(campaign.limits),
        "notes": list(notes),
    }
    return json_document(content)


def _run(end: RunEnd, replay: ReplayCommand) -> dict[str, object]:
    run, result = end.run, end.result
    return {
        "id": run.identifier,
        "rehearsal": run.rehearsal,
        "faults": [asdict(hit) for hit in run.hits],
        "outcome": result.outcome,
        "outcomes": list(run.outcomes),
        "passed": end.passed,
        "response_s": result.response_s,
        "within_s": run.within_s,
        "bound_held": end.in_time,
        "limits_held": end.limits.held,
        "excesses": [asdict(excess) for excess in end.limits.excesses],
        "sim_time_s": result.sim_time_s,
        "reason": end.crash or result.reason,
        "edited": result.edited,
        "digest": end.digest,
        "replay": replay(run.identifier),
    }


def _limits(limits: LimitsReport) -> dict[str, object]:
    largest: dict[str, CommandStep] = {}
    for step in limits.steps:
        if step.cause not in largest or abs(step.step) > abs(largest[step.cause].step):
            largest[step.cause] = step
    return {
        "held": limits.held,
        "largest_shares": {peak.quantity: peak.share for peak in limits.peaks},
        "command_steps": [
            {"count": sum(step.cause == cause for step in limits.steps), "largest": asdict(step)}
            for cause, step in sorted(largest.items())
        ],
        "held_outside": [asdict(held) for held in limits.held_outside],
        "unchecked": list(limits.unchecked),
    }
