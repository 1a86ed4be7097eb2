"""Controller managers, controllers, planning groups, named poses and Cartesian goals."""

from typing import Annotated, Literal, Union

from pydantic import Discriminator, Field, Tag

from cellc.compiler.spec.base import FrameReference, Namespace, ParameterValue
from cellc.compiler.spec.moveit import OctomapSpec, ServoSpec
from cellc.compiler.spec.quantity import (
    Duration,
    JointPosition,
    JointPositions,
    JointTolerances,
    Position,
    RollPitchYaw,
    UpdateRate,
)
from cellc.contract.stated import Name, StatedModel, Text


def _by_joint(value: object) -> str:
    return "mapping" if isinstance(value, dict) else "text"


Tolerance = Annotated[
    Union[Annotated[JointTolerances, Tag("text")], Annotated[dict[Text, JointPosition], Tag("mapping")]],
    Discriminator(_by_joint),
]
"""One figure, one for each kind of joint as in ``0.2 rad 5 mm``, or one for each joint by ``device/joint``."""


class ControllerSpec(StatedModel):
    """A controller; what it claims follows from its type and device."""

    type: Text = Field(..., description="Kind of controller in the catalog.", examples=["joint_trajectory"])
    device: Name | None = Field(None, description="Device whose joints it drives.", examples=["arm"])
    joints: tuple[Text, ...] = Field(
        (),
        description="Joints as `device/joint`; all actuated ones of the device if absent.",
        examples=[["arm/elbow_joint"]],
    )
    command_interfaces: tuple[Text, ...] = Field(
        (), description="Command interfaces; those of the kind if absent.", examples=[["position"]]
    )
    active: bool = Field(True, description="Active after start-up; false for an alternate.", examples=[True])
    goal_time: Duration | None = Field(None, description="Time allowed past the end of a trajectory.", examples=["1 s"])
    path_tolerance: Tolerance | None = Field(
        None,
        description="Largest following error on the way, of all joints, of each kind of joint, or by joint.",
        examples=["0.2 rad"],
    )
    goal_tolerance: Tolerance | None = Field(
        None,
        description="Largest error at the end, of all joints, of each kind of joint, or by joint.",
        examples=["0.01 rad"],
    )
    on_violation: Literal["abort_and_hold", "abort_and_decelerate"] = Field(
        "abort_and_hold", description="What happens on a tolerance violation.", examples=["abort_and_hold"]
    )
    client: Name | None = Field(None, description="The one node that may command it.", examples=["move_group"])
    update_rate: UpdateRate | None = Field(None, description="Slower rate than the manager's.", examples=["100 Hz"])
    parameters: dict[str, ParameterValue] = Field(
        default_factory=dict,
        description="Further parameters, dots for nesting.",
        examples=[{"action_monitor_rate": 50.0}],
    )


class SwitchSpec(StatedModel):
    """A controller switch that the cell may make while it runs."""

    activate: tuple[Name, ...] = Field((), description="Controllers to activate.", examples=[["arm_position"]])
    deactivate: tuple[Name, ...] = Field(
        (), description="Controllers to deactivate first.", examples=[["arm_trajectory"]]
    )


class ManagerSpec(StatedModel):
    """One controller manager with its update loop."""

    update_rate: UpdateRate = Field(..., description="Rate of read, update, write.", examples=["500 Hz"])
    namespace: Namespace = Field("", description="Namespace of the manager.", examples=["/left"])
    host: Name | None = Field(None, description="Host that runs it.", examples=["control_pc"])
    controllers: dict[Name, ControllerSpec] = Field(
        ...,
        description="Controllers by name.",
        examples=[{"arm_trajectory": {"type": "joint_trajectory", "device": "arm"}}],
        min_length=1,
    )
    switches: dict[Name, SwitchSpec] = Field(
        default_factory=dict,
        description="Declared controller switches by name.",
        examples=[{"to_position": {"activate": ["arm_position"], "deactivate": ["arm_trajectory"]}}],
    )


class GroupSpec(StatedModel):
    """A planning group: the chain from a base link to a tip frame."""

    base: FrameReference = Field(..., description="First link of the chain.", examples=["arm/base_link"])
    tip: FrameReference = Field(..., description="Frame that goals place.", examples=["tcp"])
    ik: Name = Field("kdl", description="What solves inverse kinematics for MoveIt.", examples=["pick_ik"])
    ik_timeout: Duration | None = Field(
        None, description="How long one solution may take; 50 ms if absent.", examples=["20 ms"]
    )
    planner: Name = Field(
        "RRTConnect", description="Planner of the pipeline `ompl`, by OMPL's name.", examples=["RRTstar"]
    )


class GoalSpec(StatedModel):
    """A Cartesian goal: where the tip of the group goes, in a frame looked up at the observation's stamp."""

    group: Name | None = Field(None, description="Group that moves; the only one if absent.", examples=["manipulator"])
    frame: FrameReference = Field(..., description="Frame that the goal is given in.", examples=["object"])
    rpy: RollPitchYaw | None = Field(None, description="Tip orientation in the frame.", examples=["180 0 0 deg"])
    xyz: Position | None = Field(
        None, description="Tip position in the frame; its origin if absent.", examples=["0 0 20 mm"]
    )
    approach: Position | None = Field(
        None,
        description="Offset in the tip's own axes of the pose before; the last part is a straight line.",
        examples=["0 0 -100 mm"],
    )
    transform_at: Literal["observation", "latest"] = Field(
        "observation", description="Stamp that transforms are looked up at.", examples=["observation"]
    )


class MotionSpec(StatedModel):
    """What the cell plans for."""

    groups: dict[Name, GroupSpec] = Field(
        default_factory=dict,
        description="Planning groups by name.",
        examples=[{"manipulator": {"base": "arm/base_link", "tip": "tcp"}}],
    )
    pipelines: tuple[Name, ...] = Field(
        ("ompl", "pilz_industrial_motion_planner"),
        description="Planning pipelines of MoveIt; the first is the default.",
        examples=[["ompl", "chomp"]],
        min_length=1,
    )
    octomap: OctomapSpec | None = Field(
        None,
        description="Occupancy map that plans keep clear of; none if absent.",
        examples=[
            {"source": "/camera/depth/image_rect_raw", "resolution": "25 mm", "range": "2 m", "padding": "30 mm"}
        ],
    )
    servo: ServoSpec | None = Field(
        None,
        description="MoveIt Servo; none if absent.",
        examples=[
            {
                "node": "servo",
                "controller": "arm_velocity",
                "linear": "0.05 m/s",
                "rotational": "0.2 rad/s",
                "joint": "0.2 rad/s",
            }
        ],
    )
    poses: dict[Name, dict[Name, JointPositions]] = Field(
        default_factory=dict,
        description="Named poses: joint positions by group, in chain order; a unit is that of all numbers before it.",
        examples=[{"home": {"manipulator": "0 -90 90 -90 -90 0 deg"}}],
    )
    goals: dict[Name, GoalSpec] = Field(
        default_factory=dict,
        description="Cartesian goals by name.",
        examples=[{"pick": {"frame": "object", "approach": "0 0 -100 mm"}}],
    )
