"""A campaign as lines for a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from cellc.mock.campaign.campaign import Campaign
from cellc.mock.campaign.limits_report import CommandStep, LimitsReport
from cellc.mock.campaign.matrix import legend, matrix_lines, matrix_of
from cellc.mock.campaign.run import SUCCEEDED, RunEnd
from cellc.mock.summary import reason

_STEPS = {
    "hold": "the command goes to where the joint is measured",
    "deceleration": "a stop begins where the joint is measured",
    "replaced": "a trajectory takes over from one that was moving",
    "off_command": "a trajectory starts where the joint is measured, not where it was commanded",
    "scaling": "the speed scaling changed",
}

ReplayCommand = Callable[[str], str]
"""Returns the command line that runs one run again, by its identifier."""


def campaign_lines(campaign: Campaign, replay: ReplayCommand) -> Iterator[str]:
    """Yield the matrix of each rehearsal, pairs, outcomes with their bounds, limits, and what failed."""
    for baseline in campaign.baselines:
        yield from matrix_lines(matrix_of(baseline.run.entry, campaign.ends))
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
    yield f"{verdict}: {total - failed} of {total} runs ended in a named outcome within bounds and limits"


def end_lines(end: RunEnd, command: str) -> Iterator[str]:
    """Yield how one run ended that was run alone."""
    result, run = end.result, end.run
    if not end.passed:
        yield from failure_lines(end, command)
        yield f"        digest: {end.digest}"
        return
    yield f"passed  {run.identifier}: {result.outcome} (named: {', '.join(run.outcomes)})"
    if run.within_s is not None and result.response_s is not None and result.outcome != SUCCEEDED:
        yield f"        bound: {result.response_s * 1e3:.0f} ms of {run.within_s * 1e3:.0f} ms"
    if text := reason(result):
        yield f"        reason: {text}"
    yield f"        digest: {end.digest}"


def failure_lines(end: RunEnd, command: str) -> Iterator[str]:
    """Yield why a run failed, and how to run it again."""
    result, run = end.result, end.run
    yield f"FAILED  {run.identifier}: {result.outcome}"
    if not end.named:
        yield f"        expected: {' or '.join(run.outcomes)}"
    elif not end.in_time and run.within_s is not None:
        took = "none" if result.response_s is None else f"{result.response_s * 1e3:.0f} ms"
        yield f"        bound: response {took}, allowed {run.within_s * 1e3:.0f} ms"
    for excess in end.limits.excesses:
        yield f"        limit: {excess}"
    if text := end.crash or reason(result):
        yield f"        reason: {text}"
    yield f"        replay: {command}"


def limit_lines(limits: LimitsReport) -> Iterator[str]:
    """Yield how near commands came to their limits, and where they stepped."""
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
    """Yield how many runs ended in each outcome, and the one that came nearest to its bound."""
    for outcome in sorted({end.result.outcome for end in ends}):
        these = [end for end in ends if end.result.outcome == outcome]
        bounded = [(_share(end), end) for end in these if outcome != SUCCEEDED and end.run.within_s]
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
