"""Planning groups, named poses and Cartesian goals."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from cellc.spec.base import FrameReference, Name, SpecModel
from cellc.spec.quantity import JointPositions, Position, RollPitchYaw


class GroupSpec(SpecModel):
    """A planning group: the chain from a base link to a tip frame."""

    base: FrameReference = Field(..., description="First link of the chain.", examples=["arm/base_link"])
    tip: FrameReference = Field(..., description="Frame that goals place.", examples=["tcp"])


class GoalSpec(SpecModel):
    """A Cartesian goal: where the tip of the group goes, in a frame looked up at the observation's stamp."""

    frame: FrameReference = Field(..., description="Frame that the goal is given in.", examples=["object"])
    group: Name | None = Field(None, description="Group that moves; the only one if absent.", examples=["manipulator"])
    xyz: Position | None = Field(None, description="Tip position in the frame; zero if absent.", examples=["0 0 20 mm"])
    rpy: RollPitchYaw | None = Field(None, description="Tip orientation in the frame.", examples=["180 0 0 deg"])
    approach: Position | None = Field(
        None,
        description="Offset in the tip's own axes of the pose before; the last part is a straight line.",
        examples=["0 0 -100 mm"],
    )
    transform_at: Literal["observation", "latest"] = Field(
        "observation", description="Stamp that transforms are looked up at.", examples=["observation"]
    )


class MotionSpec(SpecModel):
    """What the cell plans for."""

    groups: dict[Name, GroupSpec] = Field(
        default_factory=dict,
        description="Planning groups by name.",
        examples=[{"manipulator": {"base": "arm/base_link", "tip": "tcp"}}],
    )
    poses: dict[Name, dict[Name, JointPositions]] = Field(
        default_factory=dict,
        description="Named poses: joint positions by group, in chain order.",
        examples=[{"home": {"manipulator": "0 -90 90 -90 -90 0 deg"}}],
    )
    goals: dict[Name, GoalSpec] = Field(
        default_factory=dict,
        description="Cartesian goals by name.",
        examples=[{"pick": {"frame": "object", "approach": "0 0 -100 mm"}}],
    )
