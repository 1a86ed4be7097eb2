"""Grips that failed though every goal of them succeeded."""

from __future__ import annotations

from cellc.contract.attempt import Layer
from cellc.contract.contract import Contract, ContractBand
from cellc.contract.devices import ContractGripper
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.task.grip import ARRIVAL_SHARE
from cellc.tools.attempt.record import Finding
from cellc.tools.attempt.scene import NORMAL, Scene, safety_at
from cellc.tools.attempt.steps import Made

_ROUNDING = 1e-6
"""rad or m, of positions in the contract."""


def band_of(contract: Contract, made: Made) -> ContractBand | None:
    """Return where the joint of the gripper of a step must be that closes on a part; None of another step."""
    entry = made.entry
    if entry is None or entry.kind is not StepKind.GRIP or entry.command != "close" or entry.part is None:
        return None
    frame = contract.frames.get(entry.part)
    grasp = None if frame is None else frame.grasp
    return None if grasp is None else grasp.bands.get(entry.target)


def gripped_wrong(scene: Scene, made: Made) -> Finding | None:
    band = band_of(scene.contract, made)
    closed = [goal.ended for goal in made.goals if goal.ended is not None and made.is_good]
    for snapshot, each in [(at, band) for at in closed[-1:] if band] + [(scene.last(made), old) for old in scene.bands]:
        at = snapshot.positions.get(each.joint)
        if made.goals and at is not None and not each.lower <= at <= each.upper:
            text = f"joint {each.joint} is at {at:.4g}, with a part it is from {each.lower:.4g} to {each.upper:.4g}"
            if each is band and _is_open(scene.contract, made, at):
                text = f"not closed: {text}"
                return Finding(
                    Layer.TOLERANCE, AttemptOutcome.TOLERANCE_VIOLATION, snapshot.at_ns, "joint states", text
                )
            return Finding(Layer.GRIP, AttemptOutcome.GRIP_FAILURE, snapshot.at_ns, "joint states", text)
    return None


def undone(scene: Scene, made: Made) -> Finding | None:
    """Tell a step whose goals succeeded and that failed all the same: the task alone sees it, right after them."""
    line = scene.task_line()
    if line is None or safety_at(scene.contract, scene.followed, scene.components, line.at_ns)[0] not in (NORMAL, None):
        return None
    grips = any(goal.action.gripper for goal in made.goals) and not _missed(scene, made)
    layer = Layer.GRIP if grips else Layer.TOLERANCE
    outcome = AttemptOutcome.GRIP_FAILURE if grips else AttemptOutcome.TOLERANCE_VIOLATION
    return Finding(layer, outcome, line.at_ns, "/rosout", f"{line.node}: {line.text}")


def _gripper(contract: Contract, made: Made) -> ContractGripper | None:
    device = None if made.entry is None else contract.devices.get(made.entry.target)
    return None if device is None else device.gripper


def _is_open(contract: Contract, made: Made, position: float) -> bool:
    facts = _gripper(contract, made)
    return facts is not None and abs(position - facts.open) <= max(facts.goal_tolerance, _ROUNDING)


def _missed(scene: Scene, made: Made) -> bool:
    """Tell whether a gripper that holds nothing rests elsewhere than it was sent."""
    facts = _gripper(scene.contract, made)
    if facts is None or made.entry is None or band_of(scene.contract, made) is not None:
        return False
    expected = facts.open if made.entry.command == "open" else facts.closed
    position = scene.last(made).positions.get(facts.joint)
    return position is not None and abs(position - expected) > ARRIVAL_SHARE * abs(facts.closed - facts.open)
