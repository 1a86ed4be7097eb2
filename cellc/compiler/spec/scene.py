"""The solid things of the cell, each of one shape, and what is known of the surroundings of its arms."""

from typing import Annotated, Literal, Union

from pydantic import Discriminator, Field, StringConstraints, Tag

from cellc.compiler.spec.base import FrameReference
from cellc.compiler.spec.quantity import Edge, Fit, Position, RollPitchYaw
from cellc.contract.stated import StatedModel


class SolidFields(StatedModel):
    """What every solid thing states; planning avoids it, and it becomes a link of the URDF."""

    parent: FrameReference = Field(..., description="Frame that it is fixed to.", examples=["world"])
    kind: Literal["fixture", "obstacle"] = Field(
        "fixture", description="A fixture belongs to the process, an obstacle is in the way.", examples=["fixture"]
    )


class PlacedFields(SolidFields):
    """The pose of what is placed by figures."""

    xyz: Position | None = Field(
        None,
        description="Its center in the parent; of a plane the middle of its surface, of a mesh the origin of its file.",
        examples=["0 0 780 mm"],
    )
    rpy: RollPitchYaw | None = Field(
        None, description="Fixed-axis roll, pitch, yaw in the parent.", examples=["0 0 0 deg"]
    )


class BoxSpec(PlacedFields):
    """A box."""

    box: Position = Field(..., description="Full edge lengths along x, y, z.", examples=["1200 800 40 mm"])


class CylinderMeasures(StatedModel):
    """Measures of a cylinder along z."""

    radius: Edge = Field(..., description="Its radius.", examples=["60 mm"])
    length: Edge = Field(..., description="Its whole length.", examples=["700 mm"])


class CylinderSpec(PlacedFields):
    """A cylinder along z, such as a post."""

    cylinder: CylinderMeasures = Field(
        ..., description="Its measures.", examples=[{"radius": "60 mm", "length": "700 mm"}]
    )


class SphereSpec(PlacedFields):
    """A sphere."""

    sphere: Edge = Field(..., description="Its radius.", examples=["150 mm"])


class PlaneSpec(PlacedFields):
    """A flat side, such as a floor or a wall: z points to where arms move, and behind it all is solid."""

    plane: Edge = Field(
        ..., description="Edge of the square that is there for it; at least as wide as arms reach.", examples=["4 m"]
    )


class SolidMesh(StatedModel):
    """A mesh file of a package, beside the spec or in its `packages:`."""

    file: Annotated[str, StringConstraints(pattern=r"^package://[A-Za-z][A-Za-z0-9_]*/.+$", max_length=255)] = Field(
        ..., description="Its file, as a robot description names it.", examples=["package://bench/meshes/jig.stl"]
    )
    unit: Edge | None = Field(None, description="What 1 in the file is; 1 m if absent.", examples=["1 mm"])


class MeshSpec(PlacedFields):
    """A thing of any shape, from a file."""

    mesh: SolidMesh = Field(
        ..., description="Its file.", examples=[{"file": "package://bench/meshes/jig.stl", "unit": "1 mm"}]
    )


class TouchedPoints(StatedModel):
    """Points on its surface, as the tip of the robot or a probe read them in the parent, and what they are fitted to.

    A plane is fitted by least squares of the distances along its normal; a box along the axes of the parent is the
    smallest that holds the points.
    """

    shape: Literal["plane", "box"] = Field(..., description="What is fitted.", examples=["plane"])
    points: tuple[Position, ...] = Field(
        ...,
        description="The points in the parent.",
        examples=[["0 0 1 mm", "1000 0 0 mm", "0 1000 1 mm", "1000 1000 2 mm"]],
        min_length=4,
        max_length=1000,
    )
    within: Fit = Field(
        ..., description="Largest distance that a point may have from the fitted surface.", examples=["2 mm"]
    )
    free: Position | None = Field(
        None,
        description="A point on the free side of a plane, such as where the tip was before; the origin of the parent "
        "if absent.",
        examples=["500 500 300 mm"],
    )
    edge: Edge | None = Field(
        None, description="Edge of the square that is there for a plane; 4 m if absent.", examples=["4 m"]
    )


class TouchedSpec(SolidFields):
    """A plane or a box that was measured by touching it."""

    touched: TouchedPoints = Field(
        ...,
        description="The points, and what they are fitted to.",
        examples=[
            {
                "shape": "plane",
                "points": ["0 0 1 mm", "1000 0 0 mm", "0 1000 1 mm", "1000 1000 2 mm"],
                "within": "2 mm",
                "free": "500 500 300 mm",
            }
        ],
    )


_KINDS: tuple[tuple[type[SolidFields], str], ...] = (
    (BoxSpec, "box"),
    (CylinderSpec, "cylinder"),
    (SphereSpec, "sphere"),
    (PlaneSpec, "plane"),
    (MeshSpec, "mesh"),
    (TouchedSpec, "touched"),
)


def _solid_kind(value: object) -> str | None:
    if isinstance(value, dict):
        return next((kind for _, kind in _KINDS if kind in value), None)
    return next((kind for model, kind in _KINDS if isinstance(value, model)), None)


SolidSpec = Annotated[
    Union[
        Annotated[BoxSpec, Tag("box")],
        Annotated[CylinderSpec, Tag("cylinder")],
        Annotated[SphereSpec, Tag("sphere")],
        Annotated[PlaneSpec, Tag("plane")],
        Annotated[MeshSpec, Tag("mesh")],
        Annotated[TouchedSpec, Tag("touched")],
    ],
    Discriminator(
        _solid_kind,
        custom_error_type="solid-kind-missing",
        custom_error_message="a thing of the scene needs one of the keys that give its shape",
    ),
]
