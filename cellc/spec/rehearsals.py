"""What the mock backend executes: steps, faults, and the outcome each must end in."""

from __future__ import annotations

from typing import Annotated, Literal, Union

from pydantic import Discriminator, Field, Tag

from cellc.spec.base import FrameReference, Name, SpecModel, shape_of
from cellc.spec.quantity import Duration

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


class MoveStep(SpecModel):
    """Move a group to a named pose or a Cartesian goal."""

    move: Name = Field(..., description="Named pose or goal.", examples=["home"])


class DetectStep(SpecModel):
    """Wait for a fresh observation of a dynamic frame and keep its stamp for the goals that use it."""

    detect: Name = Field(..., description="Dynamic frame.", examples=["object"])


class GripStep(SpecModel):
    """Drive the gripper."""

    grip: Literal["open", "close"] = Field(..., description="Open or close.", examples=["close"])
    device: Name | None = Field(None, description="Gripper; the only one if absent.", examples=["gripper"])


class WaitStep(SpecModel):
    """Let simulated time pass."""

    wait: Duration = Field(..., description="How long.", examples=["1 s"])


_STEP_KEYS = ("move", "detect", "grip", "wait")
_FAULT_KEYS = (
    "freeze",
    "drop_frame",
    "cancel",
    "reject",
    "stick",
    "skip_cycles",
    "protective_stop",
    "unreachable",
    "delay",
)


def _first_key(value: object, keys: tuple[str, ...]) -> str | None:
    if isinstance(value, dict):
        return next((key for key in keys if key in value), None)
    return (
        next((key for key in keys if key in type(value).model_fields), None) if isinstance(value, SpecModel) else None
    )


def _step_key(value: object) -> str | None:
    return _first_key(value, _STEP_KEYS)


def _fault_key(value: object) -> str | None:
    return _first_key(value, _FAULT_KEYS)


StepSpec = Annotated[
    Union[
        Annotated[MoveStep, Tag("move")],
        Annotated[DetectStep, Tag("detect")],
        Annotated[GripStep, Tag("grip")],
        Annotated[WaitStep, Tag("wait")],
    ],
    Discriminator(
        _step_key,
        custom_error_type="step-kind-missing",
        custom_error_message="a step needs one of the keys `move`, `detect`, `grip` or `wait`",
    ),
]


class FaultFields(SpecModel):
    """When a fault begins and how long it lasts."""

    at: Duration = Field(..., description="Simulated time from the start of the rehearsal.", examples=["2 s"])
    lasting: Duration | None = Field(None, description="How long; to the end if absent.", examples=["500 ms"])


class FreezeFault(FaultFields):
    """A sensor repeats its last sample with its old stamp."""

    freeze: Name = Field(..., description="Sensor device.", examples=["camera"])


class DropFrameFault(FaultFields):
    """A frame is no longer published."""

    drop_frame: FrameReference = Field(..., description="Frame.", examples=["object"])


class CancelFault(FaultFields):
    """The client cancels the goal that is executing, or the first that executes after."""

    cancel: Literal["move", "grip"] = Field(..., description="Kind of step whose goal is cancelled.", examples=["move"])


class RejectFault(FaultFields):
    """A controller is inactive when its goal arrives."""

    reject: Name = Field(..., description="Controller.", examples=["arm_trajectory"])


class StickFault(FaultFields):
    """A joint no longer follows its command."""

    stick: FrameReference = Field(..., description="Joint, as `device/joint`.", examples=["arm/elbow_joint"])


class SkipCyclesFault(FaultFields):
    """The update loop misses cycles."""

    skip_cycles: int = Field(..., description="Number of cycles in a row.", examples=[5], ge=1, le=100_000)


class ProtectiveStopFault(FaultFields):
    """A device goes into protective stop: state stays visible, commands are refused."""

    protective_stop: Name = Field(..., description="Device.", examples=["arm"])


class UnreachableFault(FaultFields):
    """A goal moves out of the reach of its group."""

    unreachable: Name = Field(..., description="Goal.", examples=["pick"])


class DelayFault(FaultFields):
    """Joint states of a device arrive late."""

    delay: Name = Field(..., description="Device.", examples=["arm"])
    by: Duration = Field(..., description="How late.", examples=["300 ms"])


FaultSpec = Annotated[
    Union[
        Annotated[FreezeFault, Tag("freeze")],
        Annotated[DropFrameFault, Tag("drop_frame")],
        Annotated[CancelFault, Tag("cancel")],
        Annotated[RejectFault, Tag("reject")],
        Annotated[StickFault, Tag("stick")],
        Annotated[SkipCyclesFault, Tag("skip_cycles")],
        Annotated[ProtectiveStopFault, Tag("protective_stop")],
        Annotated[UnreachableFault, Tag("unreachable")],
        Annotated[DelayFault, Tag("delay")],
    ],
    Discriminator(
        _fault_key,
        custom_error_type="fault-kind-missing",
        custom_error_message="a fault needs one of the keys " + ", ".join(f"`{key}`" for key in _FAULT_KEYS),
    ),
]


FaultsSpec = Annotated[
    Union[Annotated[FaultSpec, Tag("mapping")], Annotated[tuple[FaultSpec, ...], Tag("list")]],
    Discriminator(shape_of, custom_error_type="wrong-type", custom_error_message="a fault or a list of faults"),
]


class RehearsalSpec(SpecModel):
    """One run of the mock: steps of its own or of another rehearsal, faults, and the expected end."""

    steps: tuple[StepSpec, ...] = Field((), description="Steps in order.", examples=[[{"move": "home"}]])
    use: Name | None = Field(None, description="Rehearsal whose steps are used.", examples=["pick_and_place"])
    inject: FaultsSpec = Field((), description="One fault or several.", examples=[{"freeze": "camera", "at": "2 s"}])
    expect: OutcomeName = Field("succeeded", description="Outcome that it must end in.", examples=["stale_state"])
    within: Duration | None = Field(
        None, description="Bound from the fault (or its effect's start) to the outcome.", examples=["200 ms"]
    )
    timeout: Duration | None = Field(None, description="Bound of the whole run in simulated time.", examples=["120 s"])
