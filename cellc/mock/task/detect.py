"""A detect step: wait for a fresh observation of a frame, and keep its stamp."""

from __future__ import annotations

from cellc.mock.engine.process import Waiting
from cellc.mock.record import PacketStep
from cellc.mock.task.attempt import Attempt
from cellc.mock.task.context import TaskContext
from cellc.mock.task.outcome import AttemptError, Outcome

PATIENCE_PERIODS = 10
"""An observation that stays away for ten of its periods does not come."""
DEFAULT_RATE_HZ = 10.0
"""Of a dynamic frame whose rate is not stated."""


def detect(context: TaskContext, attempt: Attempt, frame: str) -> Waiting[None]:
    """Keep the stamp of the newest observation as soon as it is young enough.

    Raises:
        AttemptError: stale_state, where none is after ten periods.
    """
    inbox = context.plant.inboxes.get(frame)
    entry = context.plant.contract.frames.get(frame)
    if inbox is None or entry is None:
        raise AttemptError(Outcome.TF_FAILURE, f"nobody observes frame {frame}")
    attempt.goal_frame = frame
    period_ns = round(1e9 / (entry.rate_hz or DEFAULT_RATE_HZ))
    until_ns = context.now_ns + PATIENCE_PERIODS * period_ns
    while inbox.newest is None or inbox.is_stale(inbox.newest.stamp_ns):
        if context.now_ns >= until_ns:
            raise AttemptError(Outcome.STALE_STATE, inbox.describe(frame))
        yield from context.pause(min(until_ns, context.now_ns + period_ns), inbox.arrived)
    context.observed[frame] = inbox.newest.stamp_ns
    attempt.goal_stamp = inbox.newest.stamp_ns
    attempt.mark(PacketStep.OBSERVED, inbox.newest.stamp_ns)
