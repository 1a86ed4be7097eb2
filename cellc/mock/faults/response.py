"""How long a cell took from a fault to the bounded end of the attempt that it ended."""

from __future__ import annotations

from collections.abc import Sequence

from cellc.contract.attempt import AttemptRecord
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.faults.registry import Injection


def response_s(injections: Sequence[Injection], records: Sequence[AttemptRecord]) -> float | None:
    """Return the time from the last fault taking effect to the bounded end of the attempt that it ended.

    A cancel takes effect when it is requested and ends when the joints stand still. Any other fault takes effect when
    it begins, or when the attempt begins that meets it, and ends with the attempt.
    """
    attempts = records[:-1]
    if not attempts:
        return None
    ended = next((record for record in attempts if record.outcome != AttemptOutcome.SUCCEEDED), attempts[-1])
    # What began after that end did not cause it.
    starts = [
        injection.start_ns
        for injection in injections
        if injection.start_ns is not None and injection.start_ns <= ended.ended_ns
    ]
    if not starts:
        return None
    if ended.outcome == AttemptOutcome.CANCELED and ended.cancel is not None:
        return ended.cancel.latency_s
    return (ended.ended_ns - max(*starts, ended.started_ns)) / 1e9
