"""A campaign for programs."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict

from cellc.mock.campaign.campaign import Campaign
from cellc.mock.campaign.limits_report import CommandStep, LimitsReport
from cellc.mock.campaign.run import RunEnd
from cellc.mock.campaign.text import ReplayCommand
from cellc.mock.summary import reason


def campaign_json(campaign: Campaign, notes: Sequence[str], replay: ReplayCommand) -> str:
    """Return the campaign as JSON: every run with its outcome, bound, limits and digest."""
    told = {
        "configuration_id": campaign.configuration_id,
        "seed": campaign.seed,
        "passed": campaign.passed,
        "runs": [_run(end, replay) for end in campaign.all_ends],
        "limits": _limits(campaign.limits),
        "notes": list(notes),
    }
    return json.dumps(told, ensure_ascii=False, indent=2)


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
        "reason": end.crash or reason(result),
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
