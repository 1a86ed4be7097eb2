"""The record of an attempt as the manufacturing cell checkpoint asks for it: rehearsed, and read from a bag.

Stamps are integer nanoseconds, ages are seconds: of simulated time in a rehearsal, and of the clock of the recording
computer in a bag.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any, Generic, NoReturn, TypeVar

from cellc.contract.frozen import dataclass as frozen_dataclass
from cellc.contract.vocabulary import AttemptOutcome, Term


class PacketStep(str, Enum):
    """The eight steps of one packet, from the observation to its result."""

    OBSERVED = "1 object pose published with image stamp"
    TRANSFORMED = "2 goal transformed into base"
    PLANNED = "3 planned against current state and scene"
    GOAL_SENT = "4 bounds checked and action goal sent"
    ACCEPTED = "5 controller accepted and updates references"
    WRITTEN = "6 hardware interface translates references"
    DRIVEN = "7 robot enforces limits and drives"
    RETURNED = "8 result and state returned"


@frozen_dataclass(frozen=True, slots=True)
class TracePoint:
    """When one of the eight steps happened."""

    step: PacketStep
    stamp_ns: int


@frozen_dataclass(frozen=True, slots=True)
class MadeStep:
    """When a step happened, and how long after the latest of the start of the attempt and the steps before."""

    stamp_ns: int
    after_s: float


@frozen_dataclass(frozen=True, slots=True)
class CancelRecord:
    """A cancel request: ``held_ns`` is the first stamp from which all joints were at standstill, None where they did
    not.

    Without a ``return_code`` no person has answered it.
    """

    requested_ns: int
    held_ns: int | None
    latency_s: float | None
    return_code: int | None


@frozen_dataclass(frozen=True, slots=True)
class ResultRecord:
    """The terminal state of an action goal as its server reported it."""

    status: str
    error_code: int | None
    error_string: str
    stamp_ns: int


MissingT = TypeVar("MissingT")
"""``None`` while a field may not be known yet, ``NoReturn`` once all of them are."""
_LATER: Any = None
"""Begin of a field that becomes known in the course of the attempt."""


@dataclass(slots=True, kw_only=True)
class AttemptFields(Generic[MissingT]):
    """Fields of one attempt to execute one step; the last one of a task has the step ``end`` and sums it up.

    Attributes:
        calibration_id: the calibrations, with revision, that the goal's transforms rest on.
        goal_stamp: stamp at which the goal's frame was looked up.
        joint_state_age: age of the joint state that was planned against.
        tf_lookup_age: age of the transform when it was looked up.
        fault_code: the reason in the words of the failed part; empty on success.
        operator_intervention: ``none``, or what a person has to do before the next attempt.
    """

    attempt_id: str
    rehearsal: str | MissingT
    step: str
    outcome: AttemptOutcome | MissingT = _LATER
    configuration_id: str
    version_tuple: Mapping[str, str]
    calibration_id: tuple[str, ...] = ()
    goal_frame: str | None = None
    goal_stamp: int | None = None
    joint_state_age: float | None = None
    tf_lookup_age: float | None = None
    plan_result: str | None = None
    controller_name: str | None = None
    action_goal_id: str | None = None
    speed_scaling: float | None = None
    safety_state: str | MissingT = _LATER
    fault_code: str | MissingT = _LATER
    cancel: CancelRecord | None = None
    result: ResultRecord | None = None
    operator_intervention: str | MissingT = _LATER
    started_ns: int | MissingT = _LATER
    ended_ns: int | MissingT = _LATER
    trace: tuple[TracePoint, ...] = ()

    @property
    def stamps(self) -> dict[PacketStep, int]:
        """When each of the eight steps happened that is known."""
        return {point.step: point.stamp_ns for point in self.trace}

    @property
    def made(self) -> dict[PacketStep, MadeStep]:
        """The steps that were made, in their order."""
        stamps, steps = self.stamps, {}
        before_ns = self.started_ns if isinstance(self.started_ns, int) else min(stamps.values(), default=0)
        for step in (step for step in PacketStep if step in stamps):
            steps[step] = MadeStep(stamps[step], (stamps[step] - before_ns) / 1e9)
            before_ns = max(before_ns, stamps[step])
        return steps


@dataclass(slots=True, kw_only=True)
class AttemptRecord(AttemptFields[NoReturn]):
    """One attempt that has ended."""


class Layer(Term):
    """Where an attempt failed, in the order in which the cell would tell it."""

    NONE = "none"
    CONNECTION = "connection"
    """Hosts, middleware or devices do not reach each other: logs alone tell it."""
    NODES = "nodes"
    """A node, controller, plugin or parameter kept something from running: logs alone tell it."""
    STOP = "stop"
    CYCLE = "missed cycle"
    OWNER = "owner of the command"
    STALE = "stale state"
    TF = "transforms"
    PLANNING = "planning"
    REJECTION = "rejected goal"
    TOLERANCE = "tolerance"
    GRIP = "grip"
    TIMEOUT = "timeout"
    CANCEL = "canceled by a client"
    UNKNOWN = "UNKNOWN"
