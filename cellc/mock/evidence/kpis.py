"""The key figures of one rehearsal against the targets of the contract."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

from cellc.contract.contract import ContractKpis
from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock.evidence.run_trace import StateChange, TraceResult
from cellc.mock.result import AttemptRecord, PacketStep, RehearsalResult
from cellc.vocabulary import AttemptOutcome


@dataclass(frozen=True, slots=True)
class Kpi:
    """One figure.

    Attributes:
        value: None where the rehearsal never came to what is measured.
        target: bound of the contract; None where it sets none.
        met: whether the bound was held; None where there is no value or no bound.
        basis: what was measured.
    """

    name: str
    unit: str
    value: float | None
    target: float | None
    met: bool | None
    basis: str


def kpis(targets: ContractKpis, result: RehearsalResult, trace: TraceResult, max_state_age_s: float) -> tuple[Kpi, ...]:
    """Return the seven figures.

    Args:
        max_state_age_s: how old a joint state may be.
    """
    attempts = [record for record in result.attempts if record.trace or record.outcome != AttemptOutcome.SUCCEEDED]
    stops = [change for change in trace.changes if change.kind == "hardware component"]
    latencies = [record.cancel.latency_s for record in attempts if record.cancel is not None]
    never_held = any(latency is None for latency in latencies)
    held = [latency for latency in latencies if latency is not None]
    stopped = _worst(held)
    return (
        _at_most(
            "plan_to_execute_s",
            "s",
            _worst(_plan_to_execute(attempts)),
            targets.plan_to_execute_s,
            "plan ready (step 3) to first motion (step 7), longest",
        ),
        _cancel(stopped, never_held, targets.cancel_s),
        _at_most("missed_cycles", "cycles", trace.missed_cycles, targets.missed_cycles, "joint states that were due"),
        _rejection(attempts, targets.stale_state_rejection, max_state_age_s),
        _at_most(
            "protective_stops",
            "stops",
            sum(change.state != "active" for change in stops),
            targets.protective_stops,
            "hardware components that left active",
        ),
        _at_most(
            "recovery_time_s",
            "s",
            _worst(_recoveries(stops)),
            targets.recovery_time_s,
            "hardware left active until it was active again, longest",
        ),
        _at_most(
            "wrong_owner_events",
            "events",
            sum(not claim.by_contract for claim in trace.claims)
            + sum(record.outcome == AttemptOutcome.WRONG_OWNER for record in attempts),
            targets.wrong_owner_events,
            "claims that the contract does not state, and attempts that another commander ended",
        ),
    )


def to_kpi_json(entry: RehearsalEntry, result: RehearsalResult, figures: Sequence[Kpi]) -> str:
    """Return the figures of a rehearsal as JSON, with the faults that were injected into it."""
    content = {
        "rehearsal": entry.name,
        "outcome": result.outcome,
        "expected": result.expected,
        "passed": result.passed,
        "faults": [fault.kind for fault in entry.faults],
        "kpis": [asdict(figure) for figure in figures],
    }
    return json.dumps(content, ensure_ascii=False, allow_nan=False, indent=2) + "\n"


def _at_most(name: str, unit: str, value: float | None, target: float | None, basis: str) -> Kpi:
    met = None if value is None or target is None else value <= target
    return Kpi(name, unit, value, target, met, basis)


def _cancel(worst_s: float | None, never_held: bool, target_s: float | None) -> Kpi:
    basis = "cancel requested to all joints standing still, longest"
    if never_held:
        return Kpi("cancel_s", "s", None, target_s, False, f"{basis}; the joints of one did not stand still in time")
    return _at_most("cancel_s", "s", worst_s, target_s, basis)


def _rejection(attempts: Sequence[AttemptRecord], target: float | None, max_age_s: float) -> Kpi:
    """Return the share of stale data that ended its attempt, of all that was met."""
    rejected = sum(record.outcome == AttemptOutcome.STALE_STATE for record in attempts)
    used = sum(
        record.joint_state_age is not None and record.joint_state_age > max_age_s and record.action_goal_id is not None
        for record in attempts
    )
    share = rejected / (rejected + used) if rejected + used else None
    met = None if share is None or target is None else share >= target
    return Kpi("stale_state_rejection", "share", share, target, met, "attempts that stale data ended, of those it met")


def _plan_to_execute(attempts: Sequence[AttemptRecord]) -> Iterator[float]:
    for record in attempts:
        stamps = {point.step: point.stamp_ns for point in record.trace}
        if PacketStep.PLANNED in stamps and PacketStep.DRIVEN in stamps:
            yield (stamps[PacketStep.DRIVEN] - stamps[PacketStep.PLANNED]) / 1e9


def _recoveries(changes: Sequence[StateChange]) -> Iterator[float]:
    left: dict[str, int] = {}
    for change in changes:
        if change.state != "active":
            left.setdefault(change.subject, change.stamp_ns)
        elif change.subject in left:
            yield (change.stamp_ns - left.pop(change.subject)) / 1e9


def _worst(values: Iterator[float] | Sequence[float]) -> float | None:
    return max(values, default=None)
