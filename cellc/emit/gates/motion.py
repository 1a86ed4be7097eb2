"""Gates G6 and G7: one joint, then a short trajectory."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.emit.gates.gate import Check, Gate

_RECORD = "Record the attempt with `config/recording_qos.yaml`; its first lines hold the command"


def one_joint(cell: Cell) -> Gate:
    """Return the gate of the single-joint move that the spec states."""
    first = cell.spec.bringup.first_motion
    if first is None:
        said = "`bringup.first_motion` is not stated: joint, sign, largest change, speed, timeout, reasons to stop"
        stop: tuple[str, ...] = ("no stated first motion",)
    else:
        said = (
            f"Said aloud before it moves: joint {first.joint}, direction {first.direction}, at most "
            f"{first.max_delta.text}, {first.velocity.text}, ends within {first.timeout.text}"
        )
        stop = first.stop_if
    return Gate(
        code="G6",
        title="One joint",
        state="reduced speed and range",
        checks=(
            Check(said),
            Check(_RECORD),
            Check("The joint moved in the stated direction and back, and no other joint moved", _states(cell)),
            Check("The position that the controller reports is the physical one"),
        ),
        evidence="G6-command-state-error.md",
        owner=cell.spec.safety.recovery.observer,
        stop=stop,
    )


def trajectory(cell: Cell) -> Gate:
    """Return the gate of a short action with feedback and cancellation."""
    bounds = tuple(
        Check(f"A cancel on `{interface.name}` holds within {interface.cancel_within_s} s")
        for interface in cell.interfaces
        if interface.cancel_within_s is not None
    )
    return Gate(
        code="G7",
        title="Trajectory",
        state="reduced envelope",
        checks=(
            Check(_RECORD),
            Check("A short goal is accepted, fed back and ended with a result"),
            *bounds,
            Check("The attempt record holds every field of the contract's `attempt_fields`"),
        ),
        evidence="G7-attempt.jsonl",
        owner=cell.spec.owners.approvals.graph,
        stop=("a cancel or hold that is not clear", "a result that does not say which layer failed"),
    )


def _states(cell: Cell) -> tuple[str, ...]:
    names = dict.fromkeys(manager.namespace for manager in cell.managers)
    return tuple(f"ros2 topic echo --once {namespace}/joint_states" for namespace in names)
