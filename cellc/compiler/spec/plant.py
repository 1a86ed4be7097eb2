"""The spec of a plant: cells that are built, owned and reviewed apart, and what lies between them."""

from typing import Literal

from pydantic import Field

from cellc.compiler.spec.base import FrameReference, InterfaceType, PackageName
from cellc.compiler.spec.cell_spec import CellSpec, TopicName
from cellc.compiler.spec.devices import PlacementSpec
from cellc.compiler.spec.frames import AreaSpec
from cellc.contract.stated import Name, StatedModel, Text

PART_KEY = "cells"
"""The section that makes a spec that of a plant."""


def spec_model(data: object) -> type[StatedModel]:
    """Return the model that reads a spec: that of a plant where it has cells, else that of a cell."""
    return PlantSpec if isinstance(data, dict) and PART_KEY in data else CellSpec


class PartSpec(StatedModel):
    """A cell of the plant: its spec, where it is, and who owns it."""

    spec: Text = Field(
        ...,
        description="Its spec, relative to this file and in its repository; it is checked and built from there.",
        examples=["line_1/cell.yaml"],
    )
    mount: PlacementSpec = Field(
        ...,
        description="Where the world of the cell is: in the world of the plant, or in a fixed frame of another cell.",
        examples=[{"parent": "world", "xyz": "6 0 0 m", "rpy": "0 0 180 deg"}],
    )
    owner: Text = Field(..., description="Person or role responsible for it.", examples=["line_team"])


class CrossingSpec(StatedModel):
    """A topic from one cell to others; its name begins with the key of the cell that publishes it."""

    topic: InterfaceType = Field(..., description="Message type.", examples=["std_msgs/msg/Bool"])
    from_: FrameReference = Field(..., alias="from", description="Publisher, as `cell/node`.", examples=["line_1/task"])
    to: tuple[FrameReference, ...] = Field(
        ..., description="Subscribers, each as `cell/node`.", examples=[["line_2/task"]], min_length=1
    )
    owner: Text = Field(..., description="Person or role responsible for it.", examples=["logistics"])


class PlantSpec(StatedModel):
    """Cells that are built apart, as the integrator of the plant writes it."""

    format: Literal[1] = Field(..., description="Version of this spec language.", examples=[1])
    cell: PackageName = Field(..., description="Name of the plant and of the generated package.", examples=["hall"])
    summary: Text = Field(
        "", description="One sentence on what the plant does.", examples=["Two lines in one hall"], min_length=0
    )
    cells: dict[Name, PartSpec] = Field(
        ...,
        description="Cells by the name that they have in the plant.",
        examples=[{"line_1": {"spec": "line_1/cell.yaml", "mount": {"parent": "world"}, "owner": "line_team"}}],
        min_length=1,
    )
    interfaces: dict[TopicName, CrossingSpec] = Field(
        default_factory=dict,
        description="Topics from cell to cell by their name in the plant.",
        examples=[
            {
                "/line_1/part_ready": {
                    "topic": "std_msgs/msg/Bool", "from": "line_1/task", "to": ["line_2/task"], "owner": "logistics",
                }
            }
        ],
    )  # fmt: skip
    areas: dict[Name, AreaSpec] = Field(
        default_factory=dict,
        description="Volumes that arms of several cells share, by name.",
        examples=[{"hand_over": {"parent": "world", "box": "1 2 2 m", "granted_by": "safety_plc"}}],
    )
