"""What MoveIt does beyond planning, where a cell wants it: an occupancy map, and servoing."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from cellc.compiler.spec.quantity import Edge, Frequency, JointVelocity, Length, Period, Velocity
from cellc.contract.stated import Name, StatedModel

Topic = Annotated[str, StringConstraints(pattern=r"^(/[A-Za-z_][A-Za-z0-9_]*)+$", max_length=256)]


class OctomapSpec(StatedModel):
    """The occupancy map of move_group, fed by a depth image or a point cloud that it subscribes to."""

    source: Topic = Field(
        ...,
        description="Interface that feeds it: a depth image, with its camera info beside it, or a point cloud.",
        examples=["/camera/depth/image_rect_raw"],
    )
    resolution: Edge = Field(..., description="Edge of a cell of the map.", examples=["25 mm"])
    range: Edge = Field(..., description="Distance beyond which nothing is put in.", examples=["2 m"])
    padding: Length = Field(
        ..., description="How much larger the robot is taken when it is cut out of the data.", examples=["30 mm"]
    )
    rate: Frequency | None = Field(None, description="Updates of the map; 1 Hz if absent.", examples=["2 Hz"])


class ServoSpec(StatedModel):
    """MoveIt Servo: a node of the cell that turns twists, joint speeds or poses into commands of one controller."""

    node: Name = Field(..., description="Node that runs it.", examples=["servo"])
    controller: Name = Field(
        ..., description="Controller that it commands, whose client it is.", examples=["arm_velocity"]
    )
    group: Name | None = Field(None, description="Group that moves; the only one if absent.", examples=["manipulator"])
    commands: Literal["speed_units", "unitless"] = Field(
        "speed_units",
        description="What it is sent: m/s and rad/s, or shares of the largest speeds from -1 to 1.",
        examples=["unitless"],
    )
    linear: Velocity = Field(..., description="Largest speed along an axis.", examples=["0.05 m/s"])
    rotational: JointVelocity = Field(..., description="Largest speed about an axis.", examples=["0.2 rad/s"])
    joint: JointVelocity = Field(..., description="Largest speed of a joint.", examples=["0.2 rad/s"])
    period: Period | None = Field(
        None, description="Time from one command of the controller to the next; 10 ms if absent.", examples=["4 ms"]
    )
    command_timeout: Period | None = Field(
        None, description="Silence after which it halts the joints; 100 ms if absent.", examples=["100 ms"]
    )
