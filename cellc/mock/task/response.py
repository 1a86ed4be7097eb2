"""The wait for the answer of a server, with its bound: a responder that is missing blocks nobody for ever."""

from __future__ import annotations

from cellc.mock.engine.process import Waiting
from cellc.mock.task.context import TaskContext
from cellc.mock.task.outcome import AttemptError, Outcome

RESPONSE_S = 1.0
"""How long a goal request may stay unanswered; a server answers within milliseconds or not at all."""


def await_response(context: TaskContext, server: str) -> Waiting[None]:
    """Return at once where a server answers; raise AttemptError, timeout, where it does not within the bound."""
    if server not in context.plant.requests.unresponsive:
        return
    yield from context.rest(RESPONSE_S)
    raise AttemptError(Outcome.TIMEOUT, f"no answer of {server} within {RESPONSE_S:g} s")
