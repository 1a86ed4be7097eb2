"""A grip step: drive the gripper, and let it take or release an object that is between its fingers."""

from __future__ import annotations

import math

from cellc.contract.contract import ContractBand
from cellc.contract.devices import ContractGripper
from cellc.contract.vocabulary import AttemptOutcome, Behavior
from cellc.mock.control import GripperGoal
from cellc.mock.engine.process import Waiting
from cellc.mock.task.bounds import grip_timeout_s
from cellc.mock.task.context import Attempt, AttemptError, CurrentState, TaskContext
from cellc.mock.task.execute import execute, require_success
from cellc.mock.task.fingers import body_of, release, take, tip_link
from cellc.mock.task.move import state_since

ARRIVAL_SHARE = 0.05
"""Share of its stroke by which a gripper may miss the position where it should come to rest."""
_ROUNDING = 1e-6
"""rad or m, of positions in the contract."""


def grip(context: TaskContext, attempt: Attempt, device: str, command: str, part: str | None) -> Waiting[None]:
    """Open or close a gripper; raise AttemptError where it does not get there, or holds what it should not.

    Args:
        part: what is to be between the fingers that close; None of nothing.
    """
    named = context.contract.devices.get(device)
    facts = None if named is None else named.gripper
    if facts is None or facts.controller is None:
        raise AttemptError(AttemptOutcome.GOAL_REJECTION, f"no controller drives gripper {device}")
    closes, parts = command == "close", context.plant.parts
    between = parts.between(device, tip_link(context.plant, device), context.now_ns) if closes else None
    if between is not None:
        parts.stop_fingers(device, between)
    if not closes:
        context.bands.pop(device, None)
        parts.measure(device, body_of(context.plant, device), context.now_ns)
    target = facts.closed if closes else facts.open
    goal = _goal(context, facts, target)
    timeout_s = grip_timeout_s(context.contract, facts.controller)
    ended = yield from execute(context, attempt, "grip", facts.controller, goal, timeout_s)
    require_success(ended, context)
    state = yield from state_since(context, ended.decided_ns)
    context.plant.loads.hold(device, holds=closes)
    if between is not None:
        take(context.plant, device, between)
        context.acting_on = None
    grasp, band = parts.grasp(part), parts.band(part, device)
    if closes and band is not None:
        require_part(state, facts, band)
        context.bands[device] = band
    elif not closes or grasp is None or grasp.width_m is None:
        require_arrival(state, facts, target)
    if not closes:
        release(context.plant, device)


def require_part(state: CurrentState, facts: ContractGripper, band: ContractBand) -> None:
    """Raise AttemptError where closed fingers are elsewhere than with a right part between them."""
    position = state.positions.get(band.joint, math.nan)
    if band.lower <= position <= band.upper:
        return
    expected = f"with a part expected from {band.lower:.4g} to {band.upper:.4g} {facts.unit}"
    found = f"joint {band.joint} is at {position:.4g} {facts.unit}, {expected}"
    within = max(facts.goal_tolerance, _ROUNDING)
    if not abs(position - facts.open) > within:  # an unknown position is no arrival either
        raise AttemptError(AttemptOutcome.TOLERANCE_VIOLATION, f"not closed: {found}")
    reason = "empty" if abs(position - facts.closed) <= within else "wrong part"
    raise AttemptError(AttemptOutcome.GRIP_FAILURE, f"{reason}: {found}")


def require_arrival(state: CurrentState, facts: ContractGripper, expected: float) -> None:
    """Raise AttemptError where the fingers are elsewhere: a controller may call any stall a success."""
    allowed = ARRIVAL_SHARE * abs(facts.closed - facts.open)
    position = state.positions.get(facts.joint, math.nan)
    if not abs(position - expected) <= allowed:  # an unknown position is no arrival either
        text = f"joint {facts.joint} is at {position:.4g}, expected {expected:.4g} within {allowed:.2g} {facts.unit}"
        raise AttemptError(AttemptOutcome.TOLERANCE_VIOLATION, text)


def _goal(context: TaskContext, facts: ContractGripper, position: float) -> GripperGoal:
    """Return the goal; GripperCommand has a field for effort, ParallelGripperCommand needs an interface for it."""
    for manager in context.contract.managers.values():
        controller = manager.controllers.get(facts.controller or "")
        if controller is not None and controller.behavior is Behavior.POSITION_GRIPPER:
            return GripperGoal(position=(position,), effort=(facts.max_effort,))
    return GripperGoal(position=(position,), joint_names=(facts.joint,))
