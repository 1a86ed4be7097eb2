"""An attempt while it runs: collects what its record will say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from cellc.mock.result import AttemptRecord, CancelRecord, PacketStep, ResultRecord, TracePoint
from cellc.vocabulary import AttemptOutcome


@dataclass(frozen=True, slots=True)
class Identity:
    """What all attempts of a rehearsal share."""

    rehearsal: str
    configuration_id: str
    version_tuple: Mapping[str, str]


@dataclass(slots=True)
class Attempt:
    """Fields of the record to be, filled in as they become known; see ``AttemptRecord``."""

    identity: Identity
    number: int
    step: str
    started_ns: int
    calibration_id: tuple[str, ...] = ()
    goal_frame: str | None = None
    goal_stamp: int | None = None
    joint_state_age: float | None = None
    tf_lookup_age: float | None = None
    plan_result: str | None = None
    controller_name: str | None = None
    action_goal_id: str | None = None
    speed_scaling: float | None = None
    operator: str | None = None
    cancel: CancelRecord | None = None
    result: ResultRecord | None = None
    trace: list[TracePoint] = field(default_factory=list)

    @property
    def attempt_id(self) -> str:
        """Identifier of the attempt, the same in every run."""
        return f"{self.identity.rehearsal}-{self.number:03d}"

    def mark(self, step: PacketStep, stamp_ns: int) -> None:
        """Note when one of the eight steps of the packet happened."""
        self.trace.append(TracePoint(step, stamp_ns))

    def close(
        self, outcome: AttemptOutcome, fault_code: str, safety_state: str, intervention_due: str, now_ns: int
    ) -> AttemptRecord:
        """Return the record of the attempt; what a person did in it stands for what a person would have to do."""
        return AttemptRecord(
            attempt_id=self.attempt_id,
            rehearsal=self.identity.rehearsal,
            step=self.step,
            outcome=outcome,
            configuration_id=self.identity.configuration_id,
            version_tuple=self.identity.version_tuple,
            calibration_id=self.calibration_id,
            goal_frame=self.goal_frame,
            goal_stamp=self.goal_stamp,
            joint_state_age=self.joint_state_age,
            tf_lookup_age=self.tf_lookup_age,
            plan_result=self.plan_result,
            controller_name=self.controller_name,
            action_goal_id=self.action_goal_id,
            speed_scaling=self.speed_scaling,
            safety_state=safety_state,
            fault_code=fault_code,
            cancel=self.cancel,
            result=self.result,
            operator_intervention=self.operator or intervention_due,
            started_ns=self.started_ns,
            ended_ns=now_ns,
            trace=tuple(sorted(self.trace, key=lambda point: point.step.value)),
        )
