"""The results of a run as JSON and as lines for a terminal."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cellc.mock.result import RehearsalResult


@dataclass(frozen=True, slots=True)
class TimedResult:
    """A result with the time that the host needed, which stands in no record and no evidence."""

    result: RehearsalResult
    wall_time_s: float


def to_summary_json(configuration_id: str, timed: Sequence[TimedResult], notes: Sequence[str]) -> str:
    """Return the machine-readable summary of a run."""
    rehearsals = [
        {
            "name": each.result.name,
            "outcome": each.result.outcome,
            "expected": each.result.expected,
            "passed": each.result.passed,
            "sim_time_s": each.result.sim_time_s,
            "wall_time_s": round(each.wall_time_s, 4),
            "response_s": each.result.response_s,
            "within_s": each.result.within_s,
            "reason": reason(each.result),
        }
        for each in timed
    ]
    summary = {"configuration_id": configuration_id, "rehearsals": rehearsals, "notes": list(notes)}
    return json.dumps(summary, ensure_ascii=False, indent=2)


def to_lines(timed: Sequence[TimedResult], notes: Sequence[str]) -> Iterator[str]:
    """Yield the summary for people: one line a rehearsal, the reason below where it is not a plain success."""
    for note in notes:
        yield f"note: {note}"
    if not timed:
        yield "note: no rehearsal is declared; nothing was run, and nothing is shown"
    for each in timed:
        result = each.result
        verdict = "passed" if result.passed else "FAILED"
        speed = result.sim_time_s / each.wall_time_s if each.wall_time_s > 0.0 else 0.0
        yield (
            f"{verdict}  {result.name}: {result.outcome} (expected {result.expected}), "
            f"{result.sim_time_s:.2f} s simulated in {each.wall_time_s:.2f} s ({speed:.0f} x real time)"
        )
        if result.within_s is not None and result.response_s is not None:
            yield f"        bound: {result.response_s * 1e3:.0f} ms of {result.within_s * 1e3:.0f} ms"
        if text := reason(result):
            yield f"        reason: {text}"
        for finding in result.findings:
            yield f"        finding: {finding}"


def reason(result: RehearsalResult) -> str:
    """Return why a rehearsal ended as it did; empty after a plain success."""
    problems = [problem for stage in result.bringup for problem in stage.problems]
    if problems:
        return "; ".join(problems)
    return result.attempts[-1].fault_code if result.attempts else ""
