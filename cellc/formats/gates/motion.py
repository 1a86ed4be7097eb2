"""Gates G6 and G7: one joint, then a short trajectory."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.interface import InterfaceKind
from cellc.formats.attempt_fields import attempt_fields
from cellc.formats.gates.gate import Check, Gate
from cellc.formats.gates.releases import move_real
from cellc.formats.numbers import shortest
from cellc.formats.recorded_topics import record_command
from cellc.link.derived_joint_states import JOINT_STATE_TYPE
from cellc.spec.safety import FirstMotionSpec

_NOT_STATED = "`bringup.first_motion` is not stated: joint, sign, largest change, speed, timeout, reasons to stop"


def one_joint(cell: Cell) -> Gate:
    """Return the gate of the single-joint move that the spec states; without one there is nothing that may move."""
    first = cell.spec.bringup.first_motion
    return Gate(
        code="G6",
        title="One joint",
        shows="one joint moves as it was told: its direction, its distance, and no other joint",
        state="reduced speed and range",
        checks=(Check(_NOT_STATED),) if first is None else _first_motion(cell, first),
        evidence="G6-command-state-error.md",
        owner=cell.spec.safety.recovery.observer,
        stop=("no stated first motion",) if first is None else first.stop_if,
    )


def _first_motion(cell: Cell, first: FirstMotionSpec) -> tuple[Check, ...]:
    return (
        Check(
            f"Said aloud before it moves: joint {first.joint}, direction {first.direction}, at most "
            f"{first.max_delta.text}, {first.velocity.text}, ends within {first.timeout.text}"
        ),
        _recorded(cell, "G6"),
        Check("Positions before the move", _states(cell)),
        Check("A person moves it by that much, there and back, in reduced mode and by the vendor's procedure"),
        Check("It moved in the stated direction and back, and no other joint moved", _states(cell)),
        Check("The position that the controller reports is the physical one"),
    )


def trajectory(cell: Cell) -> Gate:
    """Return the gate of a short action with feedback and cancellation."""
    started = move_real(cell)
    release = (Check("A person releases what asks for motion", started),) if started else ()
    return Gate(
        code="G7",
        title="Trajectory",
        shows="a short goal is accepted, fed back, ended and cancelled, and the record says all of it",
        state="reduced envelope",
        checks=(
            _recorded(cell, "G7"),
            *release,
            *_servers(cell),
            Check("A short goal is accepted, fed back and ended with a result"),
            *_cancels(cell),
            Check(f"The attempt record holds {', '.join(attempt_fields(cell))}"),
        ),
        evidence="G7-attempt.md",
        owner=cell.spec.owners.approvals.graph,
        stop=("a cancel or hold that is not clear", "a result that does not say which layer failed"),
    )


def _recorded(cell: Cell, gate: str) -> Check:
    return Check("The attempt is recorded until it has ended", (" \\\n  ".join(record_command(cell, f"{gate}-bag")),))


def _servers(cell: Cell) -> Iterator[Check]:
    for interface in cell.interfaces:
        if interface.kind is InterfaceKind.ACTION and "real" in interface.targets:
            yield Check(f"`{interface.name}` has one server", (f"ros2 action info {interface.name}",))


def _cancels(cell: Cell) -> Iterator[Check]:
    for interface in cell.interfaces:
        if interface.cancel_within_s is not None and "real" in interface.targets:
            yield Check(f"A cancel on `{interface.name}` holds within {shortest(interface.cancel_within_s)} s")


def joint_state_topics(cell: Cell) -> tuple[str, ...]:
    """Return where joints are reported on real hardware."""
    return tuple(one.name for one in cell.interfaces if one.type == JOINT_STATE_TYPE and "real" in one.targets)


def _states(cell: Cell) -> tuple[str, ...]:
    return tuple(f"ros2 topic echo --once {topic}" for topic in joint_state_topics(cell))
