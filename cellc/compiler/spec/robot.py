"""What is set in the robot's own controller, and who starts its program."""

from typing import Literal

from pydantic import Field

from cellc.compiler.spec.quantity import (
    AngularStiffnesses,
    Forces,
    Inertia,
    JointDampings,
    JointStiffnesses,
    JointTorques,
    Mass,
    Moments,
    Position,
    Stiffnesses,
)
from cellc.contract.stated import StatedModel


class LoadSpec(StatedModel):
    """The part of a payload that a service tells the robot, beside the tool that its installation has."""

    mass: Mass = Field(..., description="Mass, the tool left out.", examples=["0.2 kg"])
    center_of_mass: Position = Field(
        ..., description="Center of mass in the frame where tools mount.", examples=["0 0 120 mm"]
    )
    inertia: Inertia = Field(
        ...,
        description="Inertia about the center of mass, in axes parallel to that frame: ixx iyy izz ixy ixz iyz.",
        examples=["0.0002 0.0002 0.0001 0 0 0 kg m^2"],
    )


class PayloadSpec(StatedModel):
    """Load set in the robot controller."""

    mass: Mass = Field(..., description="Mass at the flange, tool included.", examples=["0.93 kg"])
    center_of_mass: Position = Field(
        ..., description="Center of mass in the frame where tools mount.", examples=["0 0 58 mm"]
    )
    inertia: Inertia | None = Field(
        None,
        description="Inertia about the center of mass, in axes parallel to that frame: ixx iyy izz ixy ixz iyz.",
        examples=["0.0011 0.0011 0.0009 0 0 0 kg m^2"],
    )
    set_by: Literal["installation", "service"] = Field(
        "installation",
        description="How the robot gets it: by what is saved on it, or by a service of its driver.",
        examples=["installation"],
    )
    part: Mass | None = Field(
        None,
        description="Mass of what its tool holds while it is closed, at the tip of its group; if absent the heaviest "
        "`grasp` that its gripper takes, else what `mass` has beyond the tool.",
        examples=["0.1 kg"],
    )
    load: LoadSpec | None = Field(
        None,
        description="Part of it that a service tells the robot, beside the tool.",
        examples=[{"mass": "0.2 kg", "center_of_mass": "0 0 120 mm", "inertia": "0.0002 0.0002 0.0001 0 0 0 kg m^2"}],
    )


class CartesianImpedanceSpec(StatedModel):
    """Stiffness at the tool along and about the axes of the robot's own frame for it."""

    translation: Stiffnesses = Field(..., description="Along the axes.", examples=["3000 3000 3000 N/m"])
    rotation: AngularStiffnesses = Field(..., description="About the axes.", examples=["300 300 300 N m/rad"])


class ImpedanceSpec(StatedModel):
    """How stiff the robot's own controller holds what it is commanded."""

    joint: JointStiffnesses | None = Field(
        None,
        description="Of all joints, in the order of the description.",
        examples=["3000 3000 3000 2500 2500 2000 2000 N m/rad"],
    )
    damping: JointDampings | None = Field(
        None,
        description="Of the same joints; that of the driver if absent.",
        examples=["2.75 2.5 2 2 0.7 0.6 0.5 N m s/rad"],
    )
    cartesian: CartesianImpedanceSpec | None = Field(
        None,
        description="At the tool.",
        examples=[{"translation": "3000 3000 3000 N/m", "rotation": "300 300 300 N m/rad"}],
    )


class TorqueThresholdsSpec(StatedModel):
    """Torques of all joints, in the order of the description."""

    lower: JointTorques = Field(..., description="A contact is seen.", examples=["25 25 22 20 19 17 14 N m"])
    upper: JointTorques = Field(..., description="The robot stops.", examples=["35 35 32 30 29 27 24 N m"])


class ForceThresholdsSpec(StatedModel):
    """Forces along the axes of the robot's own frame for contacts."""

    lower: Forces = Field(..., description="A contact is seen.", examples=["30 30 30 N"])
    upper: Forces = Field(..., description="The robot stops.", examples=["40 40 40 N"])


class MomentThresholdsSpec(StatedModel):
    """Moments about the axes of the robot's own frame for contacts."""

    lower: Moments = Field(..., description="A contact is seen.", examples=["25 25 25 N m"])
    upper: Moments = Field(..., description="The robot stops.", examples=["35 35 35 N m"])


class CollisionSpec(StatedModel):
    """Thresholds of collisions, each from the risk assessment of the cell."""

    torque: TorqueThresholdsSpec = Field(
        ...,
        description="Thresholds of joint torques.",
        examples=[{"lower": "25 25 22 20 19 17 14 N m", "upper": "35 35 32 30 29 27 24 N m"}],
    )
    force: ForceThresholdsSpec = Field(
        ..., description="Thresholds of forces at the tool.", examples=[{"lower": "30 30 30 N", "upper": "40 40 40 N"}]
    )
    moment: MomentThresholdsSpec = Field(
        ...,
        description="Thresholds of moments at the tool.",
        examples=[{"lower": "25 25 25 N m", "upper": "35 35 35 N m"}],
    )
