"""``rehearsals.json``: what the mock executes, every name resolved."""

from __future__ import annotations

from typing import Literal

from cellc.contract.base import ContractModel

OutcomeName = Literal[
    "succeeded",
    "cancelled",
    "stale_state",
    "tf_failure",
    "planning_failure",
    "goal_rejection",
    "tolerance_violation",
    "missed_cycle",
    "protective_stop",
    "timeout",
]


class StepEntry(ContractModel):
    """One step; ``target`` is a pose, goal, frame or gripper device."""

    kind: Literal["move", "detect", "grip", "wait"]
    target: str
    command: Literal["open", "close"] | None = None
    duration_s: float | None = None


class FaultEntry(ContractModel):
    """One fault; ``target`` is the ROS name of what it hits, or the kind of step for ``cancel``."""

    kind: Literal[
        "freeze", "drop_frame", "cancel", "reject", "stick", "skip_cycles", "protective_stop", "unreachable", "delay"
    ]
    target: str
    at_s: float
    lasting_s: float | None = None
    cycles: int | None = None
    delay_s: float | None = None


class RehearsalEntry(ContractModel):
    """One rehearsal and the outcome that it must end in, within a bound from the fault's effect."""

    name: str
    steps: tuple[StepEntry, ...]
    faults: tuple[FaultEntry, ...]
    expect: OutcomeName
    within_s: float | None
    timeout_s: float


class Rehearsals(ContractModel):
    """All rehearsals of a cell."""

    format: Literal[1]
    configuration_id: str
    rehearsals: tuple[RehearsalEntry, ...]
