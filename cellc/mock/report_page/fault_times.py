"""When the faults of a rehearsal began, as far as its records tell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.contract.rehearsals import FaultEntry, FaultEvent
from cellc.mock.record import AttemptRecord, PacketStep


def fault_times(faults: Sequence[FaultEntry], attempts: Sequence[AttemptRecord]) -> tuple[float, ...]:
    """Return the instants in seconds, rising; a fault whose event never came has none."""
    return tuple(sorted(_times(faults, attempts))) if attempts else ()


def _times(faults: Sequence[FaultEntry], attempts: Sequence[AttemptRecord]) -> Iterator[float]:
    begun_ns = attempts[-1].started_ns  # the last record sums up and begins with the first step
    for fault in faults:
        if fault.event is None:
            yield begun_ns / 1e9 + (fault.at_s or 0.0)
            continue
        came_ns = _event_ns(fault.event, attempts[:-1])
        if came_ns is not None:
            yield came_ns / 1e9 + fault.event.after_s


def _event_ns(event: FaultEvent, attempts: Sequence[AttemptRecord]) -> int | None:
    if not 1 <= event.step <= len(attempts):
        return None
    record = attempts[event.step - 1]
    if event.when == "started":
        return record.started_ns
    wanted = PacketStep.ACCEPTED if event.when == "accepted" else PacketStep.DRIVEN
    return next((point.stamp_ns for point in record.trace if point.step is wanted), None)
