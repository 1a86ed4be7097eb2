"""An acknowledge step: a person lets a stopped cell go on; nothing that was asked before the stop is asked again."""

from __future__ import annotations

from cellc.mock.bringup.activation import activate
from cellc.mock.engine.process import Wait, Waiting
from cellc.mock.plant import Plant
from cellc.mock.task.attempt import Attempt
from cellc.mock.task.context import OUTCOME_OF_STOP, TaskContext
from cellc.mock.task.joint_state import current_state
from cellc.mock.task.outcome import AttemptError, Outcome

RECOVERY_S = 120.0
"""Where no KPI bounds the time from a stop to a cell that is ready."""
_LOOK_NS = 100_000_000
_FRESH_NS = 100_000_000
"""Joint states are watched that long before the cell is called ready."""


def acknowledge(context: TaskContext, attempt: Attempt, role: str) -> Waiting[None]:
    """Acknowledge the stops of a cell, activate what it needs, and look whether it is ready; no stop, nothing to do.

    Raises:
        AttemptError: the role may not acknowledge, what stopped the cell is not over in time, or it does not come up.
    """
    plant = context.plant
    if not plant.stops.present():
        return
    _require_role(plant, role)
    yield from _until_over(context)
    attempt.operator = f"acknowledged by {role}"
    plant.stops.recover()
    yield from context.let_take_effect()
    problems = yield from _activate(plant)
    if problems:
        raise AttemptError(Outcome.HARDWARE_FAULT, "; ".join(problems))
    yield from context.rest(_FRESH_NS / 1e9)
    current_state(plant)


def _require_role(plant: Plant, role: str) -> None:
    due = plant.contract.safety.acknowledge
    if role != due:
        stop = plant.stops.present()[0]
        raise AttemptError(OUTCOME_OF_STOP[stop.state], f"{role} may not acknowledge, {due} has to")


def _until_over(context: TaskContext) -> Waiting[None]:
    """Wait until what stopped the cell is over."""
    bound_s = context.plant.contract.kpis.recovery_time_s or RECOVERY_S
    until_ns = min(context.now_ns + round(bound_s * 1e9), context.deadline_ns)
    while lasting := context.plant.stops.lasting():
        if context.now_ns >= until_ns:
            text = f"{lasting[0].component} is still in {lasting[0].state} {bound_s:g} s after it was to be recovered"
            raise AttemptError(OUTCOME_OF_STOP[lasting[0].state], text)
        yield Wait(min(until_ns, context.now_ns + _LOOK_NS), (context.plant.control.changed,))


def _activate(plant: Plant) -> Waiting[tuple[str, ...]]:
    """Activate the controllers that the contract has active and that are not: each holds the position that it reads."""
    problems: tuple[str, ...] = ()
    for name, entry in plant.contract.managers.items():
        states = {each.name: each.state for each in plant.control.managers[name].list_controllers()}
        waiting = tuple(each for each, facts in entry.controllers.items() if facts.active and states[each] != "active")
        problems += yield from activate(plant, name, waiting)
    return problems
