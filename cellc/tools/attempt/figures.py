"""The key figures of the checkpoint that a bag shows, beside their targets."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from cellc.contract.attempt import PacketStep
from cellc.contract.contract import Contract
from cellc.contract.vocabulary import AttemptOutcome
from cellc.tools.attempt.follow import Followed
from cellc.tools.attempt.record import JOINT, Attempt, Figure

_OWNERS = (AttemptOutcome.WRONG_OWNER, AttemptOutcome.CLAIM_FAILURE)


def figures_of(contract: Contract, attempts: Sequence[Attempt], followed: Followed) -> tuple[Figure, ...]:
    """Return the figures; those without a value were not met in the bag."""
    targets, steps = contract.kpis, attempts[:-1]
    latencies = [each.cancel.latency_s for each in steps if each.cancel is not None]
    held = [latency for latency in latencies if latency is not None]
    errors = [goal.worst_error for goal in followed.goals if goal.worst_error > 0.0]
    has_diagnostics = bool(followed.changes)
    return (
        Figure("plan_to_execute_s", "s", _worst(_to_execute(steps)), targets.plan_to_execute_s),
        Figure("cancel_s", "s", _worst(held) if len(held) == len(latencies) else None, targets.cancel_s),
        Figure(
            "missed_cycles",
            "cycles",
            float(min(followed.end.missed, followed.end.gaps)) if has_diagnostics else None,
            targets.missed_cycles,
        ),
        Figure("protective_stops", "stops", _stops(followed) if has_diagnostics else None, targets.protective_stops),
        Figure("recovery_time_s", "s", _worst(_recoveries(followed)), targets.recovery_time_s),
        Figure(
            "wrong_owner_events",
            "events",
            float(sum(each.outcome in _OWNERS for each in steps)),
            targets.wrong_owner_events,
        ),
        Figure("following_error", JOINT, _worst(errors), None),
    )


def _worst(values: Iterable[float]) -> float | None:
    return max(values, default=None)


def _to_execute(attempts: Sequence[Attempt]) -> Iterator[float]:
    for each in attempts:
        stamps = each.stamps
        if PacketStep.PLANNED in stamps and PacketStep.DRIVEN in stamps:
            yield (stamps[PacketStep.DRIVEN] - stamps[PacketStep.PLANNED]) / 1e9


def _components(followed: Followed) -> Iterator[tuple[int, str, bool]]:
    """Yield when a hardware component became active or left it."""
    was: dict[str, bool] = {}
    for change in followed.changes:
        if change.kind == "Hardware Components" and was.get(change.subject) != (change.state == "active"):
            is_first = change.subject not in was
            was[change.subject] = change.state == "active"
            if not is_first:
                yield change.at_ns, change.subject, was[change.subject]


def _stops(followed: Followed) -> float:
    said = sum(line.text.startswith("reports ") and line.text != "reports normal" for line in followed.lines)
    return float(said + sum(not active for _, _, active in _components(followed)))


def _recoveries(followed: Followed) -> Iterator[float]:
    left: dict[str, int] = {}
    for at_ns, component, active in _components(followed):
        if not active:
            left.setdefault(component, at_ns)
        elif component in left:
            yield (at_ns - left.pop(component)) / 1e9
