"""What all spec models share: strict, frozen, no unknown keys; and the texts that serve as names."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, StringConstraints


class SpecModel(BaseModel):
    """A part of the spec as written: shape only, the user's own names and units."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid", populate_by_name=True, regex_engine="python-re")


# Device, controller, node and interface tokens end up in ROS graph names: one token of `[A-Za-z_][A-Za-z0-9_]*`.
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=64)]

# REP-144: lower case, at least two characters, starts with a letter; the cell's name becomes a package name.
PackageName = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_]+$", max_length=64)]

# A frame or link: `world`, `tcp`, or `device/link`.
FrameReference = Annotated[
    str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)?$", max_length=128)
]

# A pinned version, an image digest or UNKNOWN; what is written is judged by rules, not by shape.
Pin = Annotated[str, StringConstraints(min_length=1, max_length=200)]

Text = Annotated[str, StringConstraints(min_length=1, max_length=500)]

# `sensor_msgs/msg/Image`, `control_msgs/action/FollowJointTrajectory`: whether it exists is a rule's question.
InterfaceType = Annotated[str, StringConstraints(min_length=1, max_length=200)]
