"""When the faults of a rehearsal began, in seconds of simulated time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.contract.attempt import AttemptRecord, PacketStep
from cellc.contract.rehearsals import FaultEntry, FaultEvent


def fault_times(
    faults: Sequence[FaultEntry], attempts: Sequence[AttemptRecord]
) -> tuple[tuple[float, FaultEntry], ...]:
    """Return the instant in seconds at which each fault began, rising; one whose event never occurred is left out."""
    return tuple(sorted(_started(faults, attempts), key=lambda started: started[0])) if attempts else ()


def _started(faults: Sequence[FaultEntry], attempts: Sequence[AttemptRecord]) -> Iterator[tuple[float, FaultEntry]]:
    start_ns = attempts[-1].started_ns  # the last record sums up and begins with the first step
    for fault in faults:
        if fault.event is None:
            yield start_ns / 1e9 + (fault.at_s or 0.0), fault
            continue
        came_ns = _event_ns(fault.event, attempts[:-1])
        if came_ns is not None:
            yield came_ns / 1e9 + fault.event.after_s, fault


def _event_ns(event: FaultEvent, attempts: Sequence[AttemptRecord]) -> int | None:
    if not 1 <= event.step <= len(attempts):
        return None
    record = attempts[event.step - 1]
    if event.when == "started":
        return record.started_ns
    wanted = PacketStep.ACCEPTED if event.when == "accepted" else PacketStep.DRIVEN
    return next((point.stamp_ns for point in record.trace if point.step is wanted), None)
