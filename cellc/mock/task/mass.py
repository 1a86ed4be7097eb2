"""What masses and contacts have to do with the end of a step: names and figures, which no node of the cell knows."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.contract import Contract
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.physics.drives import farthest, spent
from cellc.mock.physics.dynamics import Dynamics, pressed
from cellc.mock.physics.motions import drooping, motions, passing, stopping, toppled, unsupported
from cellc.mock.plant import Plant
from cellc.mock.task.context import AttemptError, TaskContext

_OF_PARTS = (AttemptOutcome.GRIP_FAILURE, AttemptOutcome.TOLERANCE_VIOLATION)
_CONTACT = "contact: "


def require_untouched(context: TaskContext, since_ns: int) -> None:
    """Raise AttemptError where bodies pressed on each other that are not to touch, or a part that lay was toppled."""
    dynamics = context.control.dynamics
    if dynamics is None:
        return
    if found := tuple(pressed(dynamics.seen, since_ns)):
        raise AttemptError(AttemptOutcome.TOLERANCE_VIOLATION, f"{_CONTACT}{'; '.join(map(str, found))}")
    if fallen := tuple(toppled(dynamics, since_ns, tuple(context.plant.parts.held.values()))):
        raise AttemptError(AttemptOutcome.TOLERANCE_VIOLATION, "; ".join(fallen))


def explained(
    context: TaskContext, failure: AttemptError, since_ns: int, canceled_ns: int | None = None
) -> AttemptError:
    """Return why a step failed, led by what a part is too much of, and followed by figures.

    Args:
        canceled_ns: when its goal was canceled; None where it was not.
    """
    dynamics = context.control.dynamics
    if dynamics is not None and failure.outcome is AttemptOutcome.TIMEOUT and canceled_ns is not None:
        way = stopping(tuple(motions(dynamics, canceled_ns, grippers(context.contract))))
        return AttemptError(failure.outcome, "; ".join(filter(None, (failure.fault_code, way))))
    if dynamics is None or failure.outcome not in _OF_PARTS:
        return failure
    text = "; ".join((failure.fault_code, *_figures(context, dynamics, failure, since_ns)))
    named = next(_too_much(context.plant, dynamics), None)
    return AttemptError(failure.outcome, text) if named is None else AttemptError(_OF_PARTS[0], f"{named}; {text}")


def _too_much(plant: Plant, dynamics: Dynamics) -> Iterator[str]:
    """Yield what a part is too much of, with figures."""
    for device, facts in plant.contract.devices.items():
        grip = plant.parts.grips.get(device)
        if grip is not None and grip.weakness:
            yield f"{grip.weakness}: {grip}"
        if facts.gripper is None:
            continue
        for part in dynamics.scene.parts:
            width_m = plant.parts.width_m(part)
            if width_m is None or width_m < facts.gripper.stroke_m:
                continue
            if any(touch.is_between(part, dynamics.fingers[device]) for touch in dynamics.touches()):
                open_m = facts.gripper.stroke_m
                yield f"too wide: {part} is {width_m * 1e3:.3g} mm wide, fingers of {device} open {open_m * 1e3:.3g} mm"


def _figures(context: TaskContext, dynamics: Dynamics, failure: AttemptError, since_ns: int) -> Iterator[str]:
    """Yield what pressed on what, and the joint that was farthest from its command, with what its drive gave."""
    if not failure.fault_code.startswith(_CONTACT):
        yield from (f"{_CONTACT}{each}" for each in pressed(dynamics.seen, since_ns))
    if failure.outcome is AttemptOutcome.TOLERANCE_VIOLATION:
        moved = tuple(motions(dynamics, since_ns, grippers(context.contract)))
        yield from filter(None, (drooping(moved), passing(moved)))
        away = farthest(dynamics, since_ns, grippers(context.contract))
        if away is not None:
            yield str(away)


def grippers(contract: Contract) -> frozenset[str]:
    """Return the joints of grippers, which stay away from their commands while a part is between fingers."""
    return frozenset(device.gripper.joint for device in contract.devices.values() if device.gripper is not None)


def findings(plant: Plant) -> Iterator[str]:
    """Yield what a run with masses shows that its task does not see."""
    dynamics = plant.control.dynamics
    if dynamics is None:
        return
    yield from (f"{_CONTACT}{each}" for each in pressed(dynamics.seen, 0))
    yield from (f"torque: {each}" for each in spent(dynamics, 0, grippers(plant.contract)))
    yield from unsupported(dynamics)
