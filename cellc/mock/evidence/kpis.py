"""The key figures of one rehearsal against the targets of the contract."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict

from cellc.contract.attempt import AttemptRecord, PacketStep
from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.entities import Kpis
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import RehearsalEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.evidence.run_trace import StateChange, TraceResult
from cellc.mock.result import RehearsalResult
from cellc.mock.stops import NORMAL

_READY = ("active", NORMAL)
_MEASURED = {
    "plan_to_execute_s": ("plan to execute", "s", "plan ready (step 3) to first motion (step 7), longest"),
    "cancel_s": ("cancel to hold", "s", "cancel requested to all joints standing still, longest"),
    "missed_cycles": ("missed cycles", "cycles", "joint states that were due"),
    "stale_state_rejection": ("stale data rejected", "share", "attempts that stale data ended, of those it met"),
    "protective_stops": ("protective stops", "stops", "hardware components that left active, or reported a stop"),
    "recovery_time_s": ("recovery time", "s", "hardware left active until it was active again, longest"),
    "wrong_owner_events": (
        "wrong-owner events",
        "events",
        "claims that the contract does not state, and attempts that another commander ended",
    ),
}
"""Title and unit of each figure, and what was measured."""
TITLES = {name: title for name, (title, _, _) in _MEASURED.items()}


@dataclass(frozen=True, slots=True)
class Kpi:
    """One figure.

    Attributes:
        value: None where the rehearsal ended before the measurement.
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


def kpis(targets: Kpis, result: RehearsalResult, trace: TraceResult, max_state_age_s: float) -> tuple[Kpi, ...]:
    """Return the seven figures.

    Args:
        max_state_age_s: how old a joint state may be.
    """
    attempts = [record for record in result.attempts if record.trace or record.outcome != AttemptOutcome.SUCCEEDED]
    stops = [change for change in trace.changes if change.kind in ("hardware component", "stop")]
    left_active = sum(change.state not in _READY for change in stops)
    wrong_owners = sum(not claim.by_contract for claim in trace.claims)
    wrong_owners += sum(record.outcome == AttemptOutcome.WRONG_OWNER for record in attempts)
    return (
        _at_most("plan_to_execute_s", _worst(_plan_to_execute(attempts)), targets.plan_to_execute_s),
        _cancel(attempts, targets.cancel_s),
        _at_most("missed_cycles", trace.missed_cycles, targets.missed_cycles),
        _rejection(attempts, targets.stale_state_rejection, max_state_age_s),
        _at_most("protective_stops", left_active, targets.protective_stops),
        _at_most("recovery_time_s", _worst(_recoveries(stops)), targets.recovery_time_s),
        _at_most("wrong_owner_events", wrong_owners, targets.wrong_owner_events),
    )


def to_kpi_json(entry: RehearsalEntry, result: RehearsalResult, figures: Sequence[Kpi]) -> str:
    """Return the figures of a rehearsal as JSON, with the faults that were injected into it."""
    content = {
        "rehearsal": entry.name,
        "outcome": result.outcome,
        "expected": result.expected,
        "passed": result.passed,
        "edited": result.edited,
        "faults": [fault.kind for fault in entry.faults],
        "kpis": [asdict(figure) for figure in figures],
    }
    return json_document(content)


def _at_most(name: str, value: float | None, target: float | None) -> Kpi:
    _, unit, basis = _MEASURED[name]
    met = None if value is None or target is None else value <= target
    return Kpi(name, unit, value, target, met, basis)


def _cancel(attempts: Sequence[AttemptRecord], target_s: float | None) -> Kpi:
    latencies = [record.cancel.latency_s for record in attempts if record.cancel is not None]
    held = [latency for latency in latencies if latency is not None]
    if len(held) == len(latencies):
        return _at_most("cancel_s", _worst(held), target_s)
    _, unit, basis = _MEASURED["cancel_s"]
    return Kpi("cancel_s", unit, None, target_s, False, f"{basis}; the joints of one did not stand still in time")


def _rejection(attempts: Sequence[AttemptRecord], target: float | None, max_age_s: float) -> Kpi:
    """Return the share of stale data that ended its attempt, of all that was met."""
    rejected = sum(record.outcome == AttemptOutcome.STALE_STATE for record in attempts)
    used = sum(
        record.joint_state_age is not None and record.joint_state_age > max_age_s and record.action_goal_id is not None
        for record in attempts
    )
    _, unit, basis = _MEASURED["stale_state_rejection"]
    share = rejected / (rejected + used) if rejected + used else None
    met = None if share is None or target is None else share >= target
    return Kpi("stale_state_rejection", unit, share, target, met, basis)


def _plan_to_execute(attempts: Sequence[AttemptRecord]) -> Iterator[float]:
    for record in attempts:
        stamps = {point.step: point.stamp_ns for point in record.trace}
        if PacketStep.PLANNED in stamps and PacketStep.DRIVEN in stamps:
            yield (stamps[PacketStep.DRIVEN] - stamps[PacketStep.PLANNED]) / 1e9


def _recoveries(changes: Sequence[StateChange]) -> Iterator[float]:
    left: dict[str, int] = {}
    for change in changes:
        if change.state not in _READY:
            left.setdefault(change.subject, change.stamp_ns)
        elif change.subject in left:
            yield (change.stamp_ns - left.pop(change.subject)) / 1e9


def _worst(values: Iterator[float] | Sequence[float]) -> float | None:
    return max(values, default=None)
