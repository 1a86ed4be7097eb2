"""What all contract models share: frozen, strict, no unknown keys; SI, radians, full ROS names."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field


class ContractModel(BaseModel):
    """A part of the format between the compiler and whoever executes what it made."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class ContractPose(ContractModel):
    """A rigid transform: metres and a unit quaternion x, y, z, w."""

    xyz: tuple[float, float, float] = Field(description="Position, m.")
    quaternion: tuple[float, float, float, float] = Field(description="Unit quaternion x, y, z, w.")
