"""The joint state by which the end of a goal is judged."""

from __future__ import annotations

from cellc.mock.engine.process import Waiting
from cellc.mock.task.context import TaskContext
from cellc.mock.task.joint_state import CurrentState, current_state

_LOOK_NS = 10_000_000


def state_since(context: TaskContext, instant_ns: int) -> Waiting[CurrentState]:
    """Wait for a joint state that is not older than an instant, as long as the newest one is not stale."""
    while (state := current_state(context.plant)).taken_ns < instant_ns:
        yield from context.pause(context.now_ns + _LOOK_NS)
    return state
