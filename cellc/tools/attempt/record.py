"""The record of an attempt as a bag shows it: the fields of the mock's own record, each known or UNKNOWN with why."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import Enum

from cellc.contract.contract import Contract
from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.vocabulary import AttemptOutcome, Term
from cellc.mock.result import CancelRecord, PacketStep, ResultRecord, TracePoint

UNKNOWN = "UNKNOWN"


class Layer(Term):
    """Where an attempt failed, in the order in which the cell would tell it."""

    NONE = "none"
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


LAYER_OF: Mapping[AttemptOutcome, Layer] = {
    AttemptOutcome.SUCCEEDED: Layer.NONE,
    AttemptOutcome.CANCELED: Layer.CANCEL,
    AttemptOutcome.STALE_STATE: Layer.STALE,
    AttemptOutcome.TF_FAILURE: Layer.TF,
    AttemptOutcome.PLANNING_FAILURE: Layer.PLANNING,
    AttemptOutcome.GOAL_REJECTION: Layer.REJECTION,
    AttemptOutcome.TOLERANCE_VIOLATION: Layer.TOLERANCE,
    AttemptOutcome.GRIP_FAILURE: Layer.GRIP,
    AttemptOutcome.MISSED_CYCLE: Layer.CYCLE,
    AttemptOutcome.PROTECTIVE_STOP: Layer.STOP,
    AttemptOutcome.EMERGENCY_STOP: Layer.STOP,
    AttemptOutcome.HARDWARE_FAULT: Layer.STOP,
    AttemptOutcome.WRONG_OWNER: Layer.OWNER,
    AttemptOutcome.CLAIM_FAILURE: Layer.OWNER,
    AttemptOutcome.UNCOMMANDED_MOTION: Layer.OWNER,
    AttemptOutcome.TIMEOUT: Layer.TIMEOUT,
}
"""The layer of each outcome that the mock tells apart."""


@dataclass(frozen=True, slots=True)
class Finding:
    """The layer in which an attempt failed, with the message that shows it.

    Attributes:
        outcome: as the mock names it; None where the bag does not tell.
        at_ns: time of arrival of that message.
        source: topic, or topics, that showed it.
        message: what was said, or seen.
    """

    layer: Layer
    outcome: AttemptOutcome | None
    at_ns: int
    source: str
    message: str


@dataclass(slots=True)
class Attempt:
    """One attempt to execute one step; the last one has the step ``end`` and sums up. Fields as in the mock's record.

    A field that is None is nothing where ``unknown`` does not name it; else ``unknown`` says what would have to be
    recorded.
    """

    attempt_id: str
    rehearsal: str | None
    step: str
    configuration_id: str
    version_tuple: Mapping[str, str]
    outcome: AttemptOutcome | None = None
    calibration_id: tuple[str, ...] = ()
    goal_frame: str | None = None
    goal_stamp: int | None = None
    joint_state_age: float | None = None
    tf_lookup_age: float | None = None
    plan_result: str | None = None
    controller_name: str | None = None
    action_goal_id: str | None = None
    speed_scaling: float | None = None
    safety_state: str | None = None
    fault_code: str | None = None
    cancel: CancelRecord | None = None
    result: ResultRecord | None = None
    operator_intervention: str | None = None
    started_ns: int | None = None
    ended_ns: int | None = None
    trace: tuple[TracePoint, ...] = ()
    finding: Finding | None = None
    unknown: dict[str, str] = field(default_factory=dict)

    def lack(self, name: str, needed: str) -> None:
        """Note that a field is UNKNOWN, and what would have to be recorded."""
        self.unknown[name] = needed

    @property
    def stamps(self) -> dict[PacketStep, int]:
        """When each of the eight steps happened that the bag shows."""
        return {point.step: point.stamp_ns for point in self.trace}


@dataclass(frozen=True, slots=True)
class Figure:
    """A key figure with its unit; None where nothing of the bag shows it."""

    name: str
    unit: str
    value: float | None
    target: float | None


@dataclass(frozen=True, slots=True)
class Report:
    """All that some bags show.

    Attributes:
        task: name of the rehearsal whose steps were taken for those of the task; None where none was.
        notes: what could not be read.
        missing: topics of the cell that were not recorded.
    """

    contract: Contract
    bags: tuple[str, ...]
    task: str | None
    attempts: tuple[Attempt, ...]
    figures: tuple[Figure, ...]
    notes: tuple[str, ...]
    missing: tuple[str, ...]
    messages: int
    begin_ns: int
    end_ns: int

    @property
    def end(self) -> Attempt:
        """The attempt that sums up."""
        return self.attempts[-1]


def to_json(report: Report) -> str:
    """Return the report as JSON, with the word UNKNOWN in each place that the bag does not show."""
    return json_document(
        {
            "format": 1,
            "cell": report.contract.cell,
            "configuration_id": report.contract.configuration_id,
            "bags": list(report.bags),
            "task": report.task,
            "begin_ns": report.begin_ns,
            "end_ns": report.end_ns,
            "messages": report.messages,
            "outcome": report.end.outcome or UNKNOWN,
            "attempts": [_plain_attempt(each) for each in report.attempts],
            "figures": [_plain(each) for each in report.figures],
            "notes": list(report.notes),
            "missing_topics": list(report.missing),
        }
    )


def _plain_attempt(attempt: Attempt) -> dict[str, object]:
    named = {each.name: _plain(getattr(attempt, each.name)) for each in fields(attempt)}
    return {name: UNKNOWN if value is None and name in attempt.unknown else value for name, value in named.items()}


def _plain(value: object) -> object:
    """Return a value of dataclasses as what JSON has."""
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, (Figure, Finding, CancelRecord, ResultRecord, TracePoint)):
        return {each.name: _plain(getattr(value, each.name)) for each in fields(value)}
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return dict(value) if isinstance(value, Mapping) else value
