"""What goes wrong in a rehearsal: the kind of a fault is its first key, with what it hits."""

from typing import Annotated, ClassVar, Literal, Union

from pydantic import Discriminator, Field, Tag

from cellc.compiler.spec.base import MOST, FrameReference, Name, SpecModel, Text, shape_of
from cellc.compiler.spec.quantity import Duration, JointPosition, JointSpeed, Share, TimeShift
from cellc.contract.vocabulary import FaultKind


class PhaseSpec(SpecModel):
    """A moment before the first step: the bring-up comes to a phase."""

    phase: Literal["start", "activate", "claim"] = Field(
        ..., description="Before anything of this phase of the bring-up.", examples=["claim"]
    )


class EventSpec(SpecModel):
    """A moment in a rehearsal, defined by the progress of a step."""

    step: int = Field(..., description="Number of the step, counted from 1.", examples=[3], ge=1, le=MOST)
    when: Literal["started", "accepted", "moving"] = Field(
        "started",
        description="Before the first action of the step, when a controller took its goal, or at the first motion.",
        examples=["accepted"],
    )
    after: Duration | None = Field(None, description="Simulated time after that.", examples=["100 ms"])


def _moment(value: object) -> str:
    if shape_of(value) != "mapping":
        return "time"
    return "phase" if first_key(value, ("phase",)) else "event"


MomentSpec = Annotated[
    Union[Annotated[Duration, Tag("time")], Annotated[EventSpec, Tag("event")], Annotated[PhaseSpec, Tag("phase")]],
    Discriminator(_moment),
]


class FaultFields(SpecModel):
    """When a fault begins and how long it lasts."""

    SHARED_AFTER: ClassVar[str] = "every other"

    at: MomentSpec = Field(
        ...,
        description="Simulated time from the start of the rehearsal, an event of a step, or a phase of the bring-up.",
        examples=["2 s", {"step": 3, "when": "accepted", "after": "100 ms"}],
    )
    lasting: Duration | None = Field(None, description="How long; to the end if absent.", examples=["500 ms"])


class FreezeFault(FaultFields):
    """A device repeats its last sample with its old stamp: a camera its image, an arm its joint state."""

    freeze: Name = Field(..., description="Camera, or device with joints.", examples=["camera"])


class DelayFault(FaultFields):
    """The samples of a device arrive late: the images of a camera, the joint states of an arm."""

    delay: Name = Field(..., description="Camera, or device with joints.", examples=["arm"])
    by: Duration = Field(..., description="How late.", examples=["300 ms"])


class DropFrameFault(FaultFields):
    """A frame is no longer published."""

    drop_frame: FrameReference = Field(..., description="Frame.", examples=["object"])


class DoubleFrameFault(FaultFields):
    """A second node publishes a frame, and places it elsewhere."""

    double_frame: FrameReference = Field(..., description="Frame.", examples=["object"])


class JumpClockFault(FaultFields):
    """A clock jumps, forwards, or back with a negative duration."""

    jump_clock: Name = Field(..., description="Host, device with a clock of its own, or domain.", examples=["ros"])
    by: TimeShift = Field(..., description="How far.", examples=["-1 s"])


class MismatchQosFault(FaultFields):
    """An endpoint comes back with a profile that its peers do not match: it is never connected again."""

    mismatch_qos: Text = Field(..., description="Interface.", examples=["/object_pose"])


class UnresponsiveFault(FaultFields):
    """A server answers nothing: no goal response, no result, no answer to a cancel."""

    unresponsive: Name = Field(
        ..., description="Controller with an action, or node that serves one.", examples=["move_group"]
    )


class UnreachableFault(FaultFields):
    """A goal moves out of the reach of its group."""

    unreachable: Name = Field(..., description="Goal.", examples=["pick"])


class RejectFault(FaultFields):
    """A controller is inactive when its goal arrives."""

    reject: Name = Field(..., description="Controller.", examples=["arm_trajectory"])


class CancelFault(FaultFields):
    """The client cancels the goal that is executing, or the first that executes after."""

    cancel: Literal["move", "grip"] = Field(..., description="Kind of step whose goal is canceled.", examples=["move"])


class SecondCommanderFault(FaultFields):
    """Another client sends a goal to the action of a controller."""

    second_commander: Name = Field(..., description="Controller.", examples=["arm_trajectory"])


class SwitchFault(FaultFields):
    """Somebody switches controllers: as a declared switch says, or one controller off and on again."""

    switch: Name = Field(..., description="Declared switch, or controller that is restarted.", examples=["to_effort"])


class StickFault(FaultFields):
    """A joint no longer follows its command."""

    stick: FrameReference = Field(..., description="Joint, as `device/joint`.", examples=["arm/elbow_joint"])


class SlowFault(FaultFields):
    """A joint follows its command no faster than it can."""

    slow: FrameReference = Field(..., description="Joint, as `device/joint`.", examples=["arm/elbow_joint"])
    to: JointSpeed = Field(..., description="Its speed.", examples=["2 deg/s"])


class DisplaceFault(FaultFields):
    """A joint is offset from its command, as after a push or a slipped gear."""

    displace: FrameReference = Field(..., description="Joint, as `device/joint`.", examples=["arm/elbow_joint"])
    by: JointPosition = Field(..., description="How far.", examples=["0.3 rad"])


class ScaleSpeedFault(FaultFields):
    """A device scales its speed, as with a slider or a safety function."""

    scale_speed: Name = Field(..., description="Device with speed scaling.", examples=["arm"])
    to: Share = Field(..., description="Share of the programmed speed.", examples=["0 %"])


class SkipCyclesFault(FaultFields):
    """The update loop misses cycles."""

    skip_cycles: int = Field(..., description="Number of cycles in a row.", examples=[5], ge=1, le=100_000)


class WrongPayloadFault(FaultFields):
    """An arm carries another load than the one set in it: it stops itself whenever it moves."""

    wrong_payload: Name = Field(..., description="Arm.", examples=["arm"])


class ProtectiveStopFault(FaultFields):
    """A device goes into protective stop: state stays visible, commands are refused."""

    protective_stop: Name = Field(..., description="Device.", examples=["arm"])


class EmergencyStopFault(FaultFields):
    """A device loses the power of its drives: brakes hold it, state stays visible, commands are refused."""

    emergency_stop: Name = Field(..., description="Device.", examples=["arm"])


class RestartDriverFault(FaultFields):
    """The driver of a device ends and comes back after ``lasting``: unconfigured, with an old goal waiting."""

    restart_driver: Name = Field(..., description="Device.", examples=["arm"])


class CutNetworkFault(FaultFields):
    """Nothing passes between a device and its host."""

    cut_network: Name = Field(..., description="Device.", examples=["arm"])


class ProgramStopFault(FaultFields):
    """The program on a device's own controller stops; it follows no set points until it starts, after ``lasting``."""

    program_stop: Name = Field(..., description="Device whose set points pass through a program.", examples=["arm"])


class ProgramStartFault(FaultFields):
    """Somebody starts the program on a device's own controller: from now on it follows set points."""

    program_start: Name = Field(..., description="Device whose set points pass through a program.", examples=["arm"])


class JogFault(FaultFields):
    """Somebody moves a joint by the pendant, which the robot lets them do while its program is stopped."""

    jog: FrameReference = Field(..., description="Joint, as `device/joint`.", examples=["arm/elbow_joint"])
    by: JointPosition = Field(..., description="How far.", examples=["5 deg"])


class StaleSetPointsFault(FaultFields):
    """The program of a device stops, somebody jogs its first joint, and the program starts again."""

    stale_set_points: Name = Field(..., description="Device whose set points pass through a program.", examples=["arm"])


class BrakesClosedFault(FaultFields):
    """The brakes of a device are closed; ``lasting`` until a person opens them."""

    brakes_closed: Name = Field(..., description="Device whose claim needs open brakes.", examples=["arm"])


class SilentSensorFault(FaultFields):
    """The sensors of a switched device read for ever what they read now."""

    silent_sensor: Name = Field(..., description="Device with sensors.", examples=["gripper"])


FAULT_KEYS: tuple[str, ...] = tuple(kind.value for kind in FaultKind)


def first_key(value: object, keys: tuple[str, ...]) -> str | None:
    """Return the first of ``keys`` that a mapping or a model has: the branch of a union that is reported by its
    keys."""
    if isinstance(value, dict):
        return next((key for key in keys if key in value), None)
    fields = type(value).model_fields if isinstance(value, SpecModel) else {}
    return next((key for key in keys if key in fields), None)


def _fault_key(value: object) -> str | None:
    return first_key(value, FAULT_KEYS)


FaultSpec = Annotated[
    Union[
        Annotated[FreezeFault, Tag("freeze")],
        Annotated[DelayFault, Tag("delay")],
        Annotated[DropFrameFault, Tag("drop_frame")],
        Annotated[DoubleFrameFault, Tag("double_frame")],
        Annotated[JumpClockFault, Tag("jump_clock")],
        Annotated[MismatchQosFault, Tag("mismatch_qos")],
        Annotated[UnresponsiveFault, Tag("unresponsive")],
        Annotated[UnreachableFault, Tag("unreachable")],
        Annotated[RejectFault, Tag("reject")],
        Annotated[CancelFault, Tag("cancel")],
        Annotated[SecondCommanderFault, Tag("second_commander")],
        Annotated[SwitchFault, Tag("switch")],
        Annotated[StickFault, Tag("stick")],
        Annotated[SlowFault, Tag("slow")],
        Annotated[DisplaceFault, Tag("displace")],
        Annotated[ScaleSpeedFault, Tag("scale_speed")],
        Annotated[SkipCyclesFault, Tag("skip_cycles")],
        Annotated[WrongPayloadFault, Tag("wrong_payload")],
        Annotated[ProtectiveStopFault, Tag("protective_stop")],
        Annotated[EmergencyStopFault, Tag("emergency_stop")],
        Annotated[RestartDriverFault, Tag("restart_driver")],
        Annotated[CutNetworkFault, Tag("cut_network")],
        Annotated[ProgramStopFault, Tag("program_stop")],
        Annotated[ProgramStartFault, Tag("program_start")],
        Annotated[JogFault, Tag("jog")],
        Annotated[StaleSetPointsFault, Tag("stale_set_points")],
        Annotated[BrakesClosedFault, Tag("brakes_closed")],
        Annotated[SilentSensorFault, Tag("silent_sensor")],
    ],
    Discriminator(
        _fault_key,
        custom_error_type="fault-kind-missing",
        custom_error_message="a fault needs one of the keys " + ", ".join(f"`{key}`" for key in FAULT_KEYS),
    ),
]


FaultsSpec = Annotated[
    Union[Annotated[FaultSpec, Tag("mapping")], Annotated[tuple[FaultSpec, ...], Tag("list")]],
    Discriminator(shape_of, custom_error_type="wrong-type", custom_error_message="a fault or a list of faults"),
]
