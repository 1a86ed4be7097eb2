"""What all contract models share: frozen, strict, no unknown keys; SI, radians, full ROS names; and their schema."""

from typing import TypeAlias, Union

from pydantic import BaseModel, ConfigDict, Field

from cellc.contract.quantities import Coordinate, UnitQuaternion
from cellc.contract.transforms import Pose

DIALECT = "https://json-schema.org/draft/2020-12/schema"

Json: TypeAlias = Union[bool, int, float, str, list["Json"], dict[str, "Json"], None]


class ContractModel(BaseModel):
    """A part of the format between the compiler and any program that executes its packages."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, defer_build=True)


class ContractPose(ContractModel):
    """A rigid transform: meters and a unit quaternion x, y, z, w."""

    xyz: tuple[Coordinate, Coordinate, Coordinate] = Field(description="Position, m.")
    quaternion: UnitQuaternion = Field(description="Unit quaternion x, y, z, w.")

    @property
    def pose(self) -> Pose:
        """The transform as what is composed."""
        return Pose(self.xyz, self.quaternion)


def contract_schema(model: type[BaseModel]) -> dict[str, Json]:
    """Return the JSON Schema (2020-12) of one of the files between compiler and mock."""
    return {"$schema": DIALECT, **model.model_json_schema()}
