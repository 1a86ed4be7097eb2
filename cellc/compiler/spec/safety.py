"""Who is responsible for what, and the boundary that software does not cross: stop, recovery, and the gates of
bring-up."""

from typing import Annotated, Literal, Union

from pydantic import Discriminator, Field, Tag

from cellc.compiler.spec.base import FrameReference, StandardOr, shape_of
from cellc.compiler.spec.quantity import (
    Cap,
    Duration,
    Edge,
    Force,
    JointSpeed,
    JointWay,
    SpeedCap,
    Stages,
    Velocity,
)
from cellc.contract.stated import Name, StatedModel, Stop, Text
from cellc.contract.vocabulary import UNKNOWN


class RecoverySpec(StatedModel):
    """The named states that need recovery, and who acknowledges."""

    states: tuple[Name, ...] | None = Field(
        None,
        description="States that need recovery. Absent: `protective_stop`, `emergency_stop`, `fault`, and every other "
        "stop that the vendor of a device leads out of.",
        examples=[["protective_stop"]],
    )
    acknowledge: Literal["operator", "automatic"] = Field(
        "operator", description="Who acknowledges before motion goes on.", examples=["operator"]
    )
    on_reconnect: Literal["discard_goal", "resume_goal"] = Field(
        "discard_goal", description="What becomes of an old goal after a reconnect.", examples=["discard_goal"]
    )
    owner: Text = Field(UNKNOWN, description="Who owns the procedure.", examples=["safety"])
    observer: Text = Field(UNKNOWN, description="Who is at the stop during supervised motion.", examples=["operator"])


class RiskAssessmentSpec(StatedModel):
    """What the risk assessment of the cell allows; each figure is compared with the cap of `bringup.commissioning`."""

    document: Text = Field(..., description="Document with its revision.", examples=["RA-017 rev 2"])
    velocity: Velocity | None = Field(None, description="Largest speed of a tool.", examples=["250 mm/s"])
    reach: Edge | None = Field(
        None, description="Largest distance of a tool from the base of its group.", examples=["900 mm"]
    )
    force: Force | None = Field(None, description="Largest grip force.", examples=["60 N"])


class SafetySpec(StatedModel):
    """The safety boundary; cellc names it and never implements it."""

    stop: Stop = Field(
        default_factory=Stop,
        description="Stop authority and path.",
        examples=[{"authority": "safety_plc", "path": "hardwired", "independent_of": ["control_pc"]}],
    )
    recovery: RecoverySpec = Field(
        default_factory=RecoverySpec,
        description="Recovery states and acknowledgment.",
        examples=[{"acknowledge": "operator"}],
    )
    risk_assessment: RiskAssessmentSpec | None = Field(
        None,
        description="What the risk assessment allows.",
        examples=[{"document": "RA-017 rev 2", "velocity": "250 mm/s"}],
    )


class FirstMotionSpec(StatedModel):
    """Gates G6 and G7: the first moves of one device, joint by joint, announced before each."""

    joint: FrameReference = Field(..., description="First to move, as `device/joint`.", examples=["arm/wrist_3_joint"])
    direction: Literal["+", "-"] = Field(..., description="Sign of the first move.", examples=["+"])
    max_delta: JointWay = Field(
        ..., description="Range of one joint in all, of every joint with this unit.", examples=["5 deg"]
    )
    velocity: JointSpeed = Field(..., description="Speed of the move.", examples=["5 deg/s"])
    timeout: Duration = Field(..., description="Bound of the move.", examples=["5 s"])
    stop_if: tuple[Text, ...] = Field(
        ..., description="What makes the observer stop.", examples=[["wrong direction"]], min_length=1
    )


FirstMotionsSpec = Annotated[
    Union[Annotated[FirstMotionSpec, Tag("mapping")], Annotated[tuple[FirstMotionSpec, ...], Tag("list")]],
    Discriminator(shape_of, custom_error_type="wrong-type", custom_error_message="a first motion or a list of them"),
]


class CommissioningSpec(StatedModel):
    """What caps planned motion after the first goals: in stages of `velocity` and `acceleration`, up to all of them."""

    velocity: SpeedCap = Field(
        ...,
        description="Share of the joints' limits, or the speed that no path may give the tip of a group: the joints of "
        "the group then get the share at which all of them together stay below it.",
        examples=["250 mm/s", "50 %"],
    )
    acceleration: Cap = Field(..., description="Share of the joints' limits.", examples=["50 %"])
    reach: Edge | None = Field(
        None,
        description="Largest distance of a tip from the base of its group, in every stage. Poses and goals are "
        "checked; no parameter of MoveIt keeps a path within it.",
        examples=["900 mm"],
    )
    force: Force | None = Field(
        None, description="Largest force that the task asks a gripper for, in every stage.", examples=["60 N"]
    )
    stages: Stages | None = Field(
        None, description="Shares of both, in order; 10, 25, 50 and 100 % if absent.", examples=["10 50 100 %"]
    )


class BringupSpec(StatedModel):
    """Gates G0–G7 and L1–L6; a gate may be tightened, never removed."""

    gates: StandardOr = Field(
        "standard", description="`standard`, or the gates by name in order.", examples=["standard"]
    )
    first_motion: FirstMotionsSpec | None = Field(
        None,
        description="First moves of gates G6 and G7: one entry, or a list with one for each arm and axis.",
        examples=[
            {
                "joint": "arm/wrist_3_joint",
                "direction": "+",
                "max_delta": "5 deg",
                "velocity": "5 deg/s",
                "timeout": "5 s",
                "stop_if": ["wrong direction"],
            }
        ],
    )
    commissioning: CommissioningSpec | None = Field(
        None,
        description="Caps of what move_group and MoveIt Servo plan, and the stages to them in gate G7.",
        examples=[{"velocity": "250 mm/s", "acceleration": "50 %"}],
    )
