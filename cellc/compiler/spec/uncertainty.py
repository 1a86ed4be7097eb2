"""What is not known exactly, for sweeps of the mock: beside what calibrations, clocks and interfaces state already."""

from pydantic import Field

from cellc.compiler.spec.quantity import Allowance, Edges, FieldAngle, Length, Mass, Share
from cellc.contract.stated import Name, StatedModel


class CalibrationUncertaintySpec(StatedModel):
    """What the residual of a calibration does not say."""

    rotation: FieldAngle | None = Field(
        None, description="Standard deviation about each axis; none is drawn if absent.", examples=["0.1 deg"]
    )


class RegionSpec(StatedModel):
    """Where an object may lie, and how it may be turned; each place is as likely.

    A dynamic frame is that of an object about its simulated pose. A fixed one is of what lies there and is not looked
    at: it lies elsewhere, and the robot does not know.
    """

    box: Edges = Field(
        ...,
        description="Full edge lengths along x, y, z of the parent of its simulated pose; of a fixed frame its own.",
        examples=["80 120 0 mm"],
    )
    yaw: FieldAngle | None = Field(
        None, description="Full range about the same z; not turned if absent.", examples=["90 deg"]
    )


class PartUncertaintySpec(StatedModel):
    """How far a part differs from what is stated of it; drawn with `--physics`, as nothing else has masses."""

    mass: Mass | None = Field(
        None, description="Standard deviation of its mass; none is drawn if absent.", examples=["10 g"]
    )
    friction: float | None = Field(
        None,
        description="Standard deviation of the friction of its surface; none is drawn if absent.",
        examples=[0.05],
        ge=0.0,
        le=1.0,
    )


class LoadUncertaintySpec(StatedModel):
    """How far an arm holds another load than its controller is given."""

    part: Mass | None = Field(
        None, description="Standard deviation of the part's mass; none is drawn if absent.", examples=["20 g"]
    )
    compensation: Share | None = Field(
        None,
        description="Standard deviation of the share of its own weight that a controller compensates; none if absent.",
        examples=["2 %"],
    )
    payload: Mass | None = Field(
        None,
        description="Standard deviation of the mass of its tool beyond `payload`; drawn with `--physics`.",
        examples=["50 g"],
    )


class UncertaintySpec(StatedModel):
    """What a sweep draws and judges; `{}` draws what the cell states elsewhere."""

    calibrations: dict[Name, CalibrationUncertaintySpec] = Field(
        default_factory=dict,
        description="Calibrations by name, with what their residual does not say.",
        examples=[{"hand_eye": {"rotation": "0.1 deg"}}],
    )
    repeatability: dict[Name, Length] = Field(
        default_factory=dict,
        description="Arms that a group moves, with repeatability (ISO 9283) as measured; else the catalog's is drawn.",
        examples=[{"arm": "0.05 mm"}],
    )
    loads: dict[Name, LoadUncertaintySpec] = Field(
        default_factory=dict,
        description="Arms with how well their loads are known: `part` and `compensation` of those behind springs.",
        examples=[{"arm": {"part": "20 g", "compensation": "2 %"}}],
    )
    parts: dict[Name, PartUncertaintySpec] = Field(
        default_factory=dict,
        description="Frames with a grasp, with how well mass and friction of the part are known.",
        examples=[{"object": {"mass": "10 g", "friction": 0.05}}],
    )
    tolerances: dict[Name, Allowance] = Field(
        default_factory=dict,
        description="Goals by name, with the farthest that the tip may really be from where the goal really is.",
        examples=[{"pick": "5 mm"}],
    )
