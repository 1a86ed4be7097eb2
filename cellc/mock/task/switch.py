"""Steps of devices that digital outputs switch: set the outputs, and wait until the sensors tell a state."""

from __future__ import annotations

from functools import partial

from cellc.contract.devices import ContractSwitched
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.engine.process import Waiting
from cellc.mock.task.context import AttemptError, TaskContext
from cellc.mock.task.fingers import release, take, tip_link

_LOOK_NS = 10_000_000
"""The client looks at the inputs a hundred times a second."""


def switch(context: TaskContext, device: str, state: str) -> Waiting[None]:
    """Set the outputs of a device; what it holds is taken when it is there, and let go as soon as it leaves.

    Raises:
        AttemptError: goal_rejection, where nothing switches the device to such a state; grip_failure, where what it
            holds falls.
    """
    facts = _facts(context, device, state)
    plant = context.plant
    held = facts.holds is not None and plant.switches.state(device, plant.now_ns) == facts.holds
    arrives_ns = plant.switches.set(device, state, plant.now_ns)
    if held and state != facts.holds:
        plant.loads.hold(device, holds=False)
        release(plant, device)
    elif state == facts.holds:
        plant.simulation.at(arrives_ns, partial(_close, context, device, state))
    yield from ()  # the step does not wait


def _close(context: TaskContext, device: str, state: str) -> None:
    """Take what is between the jaws as they come together, unless they were opened again on their way."""
    if context.plant.switches.state(device, context.now_ns) != state:
        return
    context.plant.loads.hold(device, holds=True)
    between = context.plant.parts.between(device, tip_link(context.plant, device), context.now_ns)
    if between is not None:
        take(context.plant, device, between)
        context.acting_on = None


def sense(context: TaskContext, device: str, state: str) -> Waiting[None]:
    """Wait until the sensors of a device tell a state.

    Raises:
        AttemptError: timeout, where they do not within the time of the device.
    """
    facts = _facts(context, device, state)
    switches = context.plant.switches
    until_ns = context.now_ns + round(facts.within_s * 1e9)
    while (read := switches.read(device, context.now_ns)) != facts.states[state]:
        if context.now_ns >= until_ns:
            text = ", ".join(f"{name} reads {str(value).lower()}" for name, value in read.items())
            reason = f"{device} does not report `{state}` within {facts.within_s:g} s: {text}"
            raise AttemptError(AttemptOutcome.TIMEOUT, reason)
        yield from context.pause(min(until_ns, context.now_ns + _LOOK_NS))


def _facts(context: TaskContext, device: str, state: str) -> ContractSwitched:
    named = context.contract.devices.get(device)
    facts = None if named is None else named.switched
    if facts is None or state not in facts.states:
        raise AttemptError(AttemptOutcome.GOAL_REJECTION, f"nothing switches {device} to `{state}`")
    return facts
