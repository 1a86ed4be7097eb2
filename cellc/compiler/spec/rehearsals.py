"""What the mock executes, what it must end in, what is measured and what is recorded."""

from collections.abc import Mapping
from typing import Annotated, Literal, Union

from pydantic import Field

from cellc.compiler.spec.base import MOST, StandardOr
from cellc.compiler.spec.faults import FaultsSpec
from cellc.compiler.spec.kinds import Kinds
from cellc.compiler.spec.quantity import Confidence, Duration, PositiveDuration, Rate, Share
from cellc.contract.entities import Target
from cellc.contract.stated import Name, StatedModel, Text
from cellc.contract.vocabulary import AttemptOutcome


class MoveStep(StatedModel):
    """Move a group to a named pose or a Cartesian goal."""

    move: Name = Field(..., description="Named pose or goal.", examples=["home"])
    together: bool = Field(
        False, description="The groups of the pose move together; one after another if false.", examples=[True]
    )


class DetectStep(StatedModel):
    """Wait for a fresh observation of a dynamic frame and keep its stamp for the goals that use it."""

    detect: Name = Field(..., description="Dynamic frame.", examples=["object"])


class GripStep(StatedModel):
    """Drive the gripper."""

    grip: Literal["open", "close"] = Field(..., description="Open or close.", examples=["close"])
    device: Name | None = Field(None, description="Gripper; the only one if absent.", examples=["gripper"])


class SetStep(StatedModel):
    """Set the outputs of a switched device; the step does not wait until it is there."""

    set: Name = Field(..., description="Device that digital outputs switch.", examples=["gripper"])
    state: Name = Field(..., description="One of its states.", examples=["closed"])


class SenseStep(StatedModel):
    """Wait until the sensors of a switched device tell a state."""

    sense: Name = Field(..., description="Device with sensors.", examples=["door"])
    state: Name = Field(..., description="One of its states.", examples=["closed"])


class CallStep(StatedModel):
    """Ask a service and wait for its answer; the mock answers in place of its server."""

    call: Text = Field(..., description="Service interface of the cell.", examples=["/conveyor/start"])


class WaitStep(StatedModel):
    """Let simulated time pass."""

    wait: Duration = Field(..., description="How long.", examples=["1 s"])


class AcknowledgeStep(StatedModel):
    """Let a person acknowledge a stop, so that the cell may go on; without it every further goal is refused."""

    acknowledge: Literal["operator"] = Field(..., description="Who acknowledges.", examples=["operator"])


_STEPS: Mapping[str, type[StatedModel]] = {
    "move": MoveStep,
    "detect": DetectStep,
    "grip": GripStep,
    "set": SetStep,
    "sense": SenseStep,
    "call": CallStep,
    "wait": WaitStep,
    "acknowledge": AcknowledgeStep,
}
StepSpec = Annotated[
    Union[MoveStep, DetectStep, GripStep, SetStep, SenseStep, CallStep, WaitStep, AcknowledgeStep],
    Kinds("step", tuple(_STEPS), _STEPS.__getitem__),
]


class RehearsalSpec(StatedModel):
    """One run of the mock: steps of its own or of another rehearsal, faults, and the expected end."""

    steps: tuple[StepSpec, ...] = Field((), description="Steps in order.", examples=[[{"move": "home"}]])
    use: Name | None = Field(None, description="Rehearsal whose steps are used.", examples=["pick_and_place"])
    bring_up: Target = Field(
        "mock",
        description="Steps of the bring-up that are taken; with `real` the devices do what their vendors' drivers do.",
        examples=["real"],
    )
    inject: FaultsSpec = Field((), description="One fault or several.", examples=[{"freeze": "camera", "at": "2 s"}])
    expect: AttemptOutcome = Field(
        AttemptOutcome.SUCCEEDED, strict=False, description="Outcome that it must end in.", examples=["stale_state"]
    )
    within: Duration | None = Field(
        None, description="Bound from the fault (or its effect's start) to the outcome.", examples=["200 ms"]
    )
    timeout: PositiveDuration | None = Field(
        None, description="Bound of the whole run in simulated time.", examples=["120 s"]
    )
    success: Rate | None = Field(
        None, description="Least share of the runs of a sweep that must succeed.", examples=["99.5 %"]
    )
    confidence: Confidence | None = Field(
        None, description="How sure a verdict on that must be; 95 % if absent.", examples=["95 %"]
    )


class KpisSpec(StatedModel):
    """The key figures of the checkpoint; one without a target is a warning."""

    plan_to_execute: Duration | None = Field(
        None, description="Longest time from plan to execution.", examples=["500 ms"]
    )
    cancel: Duration | None = Field(None, description="Longest time from cancel to hold.", examples=["200 ms"])
    missed_cycles: int | None = Field(
        None, description="Missed update cycles allowed in a run.", examples=[0], ge=0, le=MOST
    )
    stale_state_rejection: Share | None = Field(
        None, description="Share of stale samples rejected.", examples=["100 %"]
    )
    protective_stops: int | None = Field(
        None, description="Protective stops allowed in a shift.", examples=[0], ge=0, le=MOST
    )
    recovery_time: Duration | None = Field(None, description="Longest time from stop to ready.", examples=["120 s"])
    wrong_owner_events: int | None = Field(
        None, description="Commands of a wrong owner allowed.", examples=[0], ge=0, le=MOST
    )


class RecordingSpec(StatedModel):
    """What every attempt leaves behind."""

    attempt_fields: StandardOr = Field(
        "standard", description="`standard` for all fields of the checkpoint, or their names.", examples=["standard"]
    )
    topics: tuple[Text, ...] = Field(
        (), description="Topics to record beyond those of the motion path.", examples=[["/diagnostics"]]
    )


class TargetSpec(StatedModel):
    """What differs between mock, simulation and the real cell."""

    hardware: Literal["mock", "sim", "real"] | None = Field(
        None, description="Hardware components used; that of the target's name if absent.", examples=["mock"]
    )
    clock: Literal["wall", "sim"] | None = Field(
        None, description="Time of every node of the target.", examples=["wall"]
    )
