"""The version tuple of the cell; devices add their own parts."""

from __future__ import annotations

from pydantic import Field

from cellc.spec.base import Pin, SpecModel


class RollbackSpec(SpecModel):
    """What to go back to when a new configuration fails."""

    image: Pin = Field(
        "UNKNOWN", description="Digest of the last workstation image that ran.", examples=["sha256:9f2c"]
    )
    configuration: Pin = Field(
        "UNKNOWN", description="Configuration id of the last cell that ran.", examples=["cfg-4d1e0a77b2c9"]
    )


class VersionsSpec(SpecModel):
    """The pinned tuple. UNKNOWN is a legal answer; it blocks the real target and stands in the audit."""

    os: Pin = Field("UNKNOWN", description="Operating system and release.", examples=["ubuntu 24.04"])
    kernel: Pin = Field("UNKNOWN", description="Kernel release as `uname -r` prints it.", examples=["6.8.0-45-generic"])
    ros: Pin = Field(..., description="ROS 2 distribution: humble, jazzy, kilted or lyrical.", examples=["jazzy"])
    rmw: Pin = Field("UNKNOWN", description="RMW implementation and its version.", examples=["rmw_fastrtps_cpp 8.4.4"])
    ros2_control: Pin = Field("UNKNOWN", description="Version of ros2_control.", examples=["4.47.0"])
    moveit: Pin = Field("UNKNOWN", description="Version of MoveIt 2.", examples=["2.12.4"])
    rollback: RollbackSpec = Field(
        default_factory=RollbackSpec,
        description="Image and configuration to go back to.",
        examples=[{"image": "sha256:9f2c", "configuration": "cfg-4d1e0a77b2c9"}],
    )
