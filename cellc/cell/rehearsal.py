"""Rehearsals with their steps and faults bound."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.cell.entity import Entity


@dataclass(frozen=True, slots=True, kw_only=True)
class Step(Entity):
    """One step: ``kind`` is move, detect, grip or wait; ``name`` is the pose, goal, frame or device."""

    kind: str
    command: str | None = None  # open or close, for grip
    duration_s: float | None = None  # for wait


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault(Entity):
    """One fault: ``kind`` as in the spec, ``name`` the ROS name of what it hits; times in simulated seconds."""

    kind: str
    at_s: float
    lasting_s: float | None = None
    cycles: int | None = None  # for skip_cycles
    delay_s: float | None = None  # for delay


@dataclass(frozen=True, slots=True, kw_only=True)
class Rehearsal(Entity):
    """A run of the mock and the outcome that it must end in."""

    steps: tuple[Step, ...]
    faults: tuple[Fault, ...]
    expect: str
    within_s: float | None
    timeout_s: float
