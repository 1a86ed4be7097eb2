"""Controller managers and controllers."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from cellc.spec.base import Name, Namespace, ParameterValue, SpecModel, Text
from cellc.spec.quantity import Duration, Frequency, JointPosition


class ControllerSpec(SpecModel):
    """A controller; what it claims follows from its type and device."""

    type: Text = Field(..., description="Kind of controller in the catalogue.", examples=["joint_trajectory"])
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
    client: Name | None = Field(None, description="The one node that may command it.", examples=["move_group"])
    goal_time: Duration | None = Field(None, description="Time allowed past the end of a trajectory.", examples=["1 s"])
    path_tolerance: JointPosition | None = Field(
        None, description="Largest following error on the way, each joint.", examples=["0.2 rad"]
    )
    goal_tolerance: JointPosition | None = Field(
        None, description="Largest error at the end, each joint.", examples=["0.01 rad"]
    )
    on_violation: Literal["abort_and_hold", "abort_and_decelerate"] = Field(
        "abort_and_hold", description="What happens on a tolerance violation.", examples=["abort_and_hold"]
    )
    update_rate: Frequency | None = Field(None, description="Slower rate than the manager's.", examples=["100 Hz"])
    parameters: dict[str, ParameterValue] = Field(
        default_factory=dict,
        description="Further parameters, dots for nesting.",
        examples=[{"action_monitor_rate": 50.0}],
    )


class SwitchSpec(SpecModel):
    """A controller switch that the cell may make while it runs."""

    activate: tuple[Name, ...] = Field((), description="Controllers to activate.", examples=[["arm_position"]])
    deactivate: tuple[Name, ...] = Field(
        (), description="Controllers to deactivate first.", examples=[["arm_trajectory"]]
    )


class ManagerSpec(SpecModel):
    """One controller manager with its update loop."""

    update_rate: Frequency = Field(..., description="Rate of read, update, write.", examples=["500 Hz"])
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
