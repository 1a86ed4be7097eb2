"""Frames, their calibrations, and the volumes that arms share."""

from pydantic import Field

from cellc.compiler.spec.base import MOST, FrameReference
from cellc.compiler.spec.devices import PlacementSpec
from cellc.compiler.spec.quantity import Duration, Frequency, Length, Mass, Position, RollPitchYaw, Sides
from cellc.contract.stated import Name, Pin, StatedModel, Text
from cellc.contract.vocabulary import UNKNOWN


class CalibrationSpec(StatedModel):
    """A measurement that a transform rests on; a new measurement gets a new revision."""

    revision: int = Field(..., description="Counts up with every new measurement.", examples=[4], ge=1, le=MOST)
    measured: Pin = Field(UNKNOWN, description="Date of the measurement, YYYY-MM-DD.", examples=["2026-07-01"])
    method: Text = Field(UNKNOWN, description="How it was measured.", examples=["charuco"])
    samples: int | None = Field(None, description="Number of observations.", examples=[40], ge=1, le=MOST)
    residual: Length | None = Field(None, description="Residual of the fit.", examples=["0.8 mm"])
    owner: Text = Field(UNKNOWN, description="Person or role responsible for it.", examples=["perception"])
    serials: dict[Name, Text] = Field(
        default_factory=dict,
        description="Serial number of each device that was measured, as on its nameplate at that time.",
        examples=[{"camera": "814412070001"}],
    )
    from_: Text | None = Field(
        None,
        alias="from",
        description="What the calibration tool wrote, beside this file or below; then it is the one truth.",
        examples=["hand_eye.calib"],
    )
    parent: FrameReference | None = Field(
        None, description="Frame in which the file has the pose, where it names another.", examples=["arm/tool0"]
    )
    child: FrameReference | None = Field(
        None, description="Frame whose pose it has, where it names another.", examples=["camera/color_optical"]
    )


class GraspSpec(StatedModel):
    """The part that lies at a frame, as fingers meet it; the task checks where they come to rest."""

    width: Length | None = Field(
        None,
        description="How far apart the fingers are that hold it; asked for where it is gripped.",
        examples=["77 mm"],
    )
    tolerance: Length | None = Field(
        None, description="How much a right part may be wider or narrower; asked for too.", examples=["2 mm"]
    )
    mass: Mass | None = Field(None, description="Its mass; asked for too.", examples=["0.2 kg"])
    size: Sides | None = Field(
        None,
        description="Its edges along x, y and z of the frame, for a simulator; if absent it is as wide everywhere.",
        examples=["40 77 60 mm"],
    )
    friction: float | None = Field(
        None,
        description="Dry friction of its surface on what it touches, above all the pads of fingers; 0.5 if absent.",
        examples=[0.5],
        ge=0.05,
        le=2.0,
    )


class FrameSpec(StatedModel):
    """A frame of the cell: fixed in its parent, or dynamic and published by a node."""

    parent: FrameReference = Field(..., description="Parent frame.", examples=["gripper/base"])
    xyz: Position | None = Field(
        None, description="Translation in the parent; zero if absent.", examples=["0 0 162 mm"]
    )
    rpy: RollPitchYaw | None = Field(
        None, description="Fixed-axis roll, pitch, yaw in the parent.", examples=["0 90 0 deg"]
    )
    calibration: Name | None = Field(None, description="Calibration that measured it.", examples=["tcp_2f"])
    designed: bool = Field(
        False,
        description="The transform is by design (a drawing), not measured: no calibration is needed.",
        examples=[True],
    )
    reference_points: int = Field(
        0,
        description="Known points of a fixture that validate direction and scale; at least three are needed.",
        examples=[3],
        ge=0,
        le=MOST,
    )
    dynamic: bool = Field(False, description="Changes while the cell runs.", examples=[True])
    published_by: Name | None = Field(
        None, description="Node or device that publishes a dynamic frame.", examples=["perception"]
    )
    rate: Frequency | None = Field(None, description="Rate of a dynamic frame.", examples=["10 Hz"])
    buffer: Duration | None = Field(None, description="History that consumers keep of it.", examples=["10 s"])
    simulated_pose: PlacementSpec | None = Field(
        None,
        description="Where the mock puts the thing that a dynamic frame follows.",
        examples=[{"parent": "world", "xyz": "300 -200 820 mm", "rpy": "180 0 0 deg"}],
    )
    grasp: GraspSpec | None = Field(
        None,
        description="The part that a dynamic frame follows, or that lies at a fixed one.",
        examples=[{"width": "77 mm", "tolerance": "2 mm", "mass": "0.2 kg"}],
    )


class AreaSpec(StatedModel):
    """A volume that several arms may stand in, one at a time unless it is released to more."""

    parent: FrameReference = Field(..., description="Frame that the volume is fixed to.", examples=["world"])
    xyz: Position | None = Field(None, description="Center of the volume in the parent.", examples=["0 500 200 mm"])
    rpy: RollPitchYaw | None = Field(
        None, description="Fixed-axis roll, pitch, yaw in the parent.", examples=["0 0 0 deg"]
    )
    box: Position = Field(..., description="Full edge lengths along x, y, z.", examples=["400 400 400 mm"])
    granted_by: Text = Field(
        ..., description="Who lets one arm in at a time on the real cell.", examples=["safety_plc"]
    )
    released: Text | None = Field(
        None, description="Why several may be in it together, and who approved it.", examples=["hand-over at 50 mm/s"]
    )
