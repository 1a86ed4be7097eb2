"""``manifest.json``: what the folder is made of, so that one id names all that evidence rests on."""

from typing import Literal

from pydantic import Field

from cellc.contract.base import ContractModel
from cellc.contract.file_names import CellName, InnerPath


class ConfigurationInputs(ContractModel):
    """What the configuration ID is taken over."""

    calibrations: dict[str, int] = Field(description="Revision of each calibration.")
    tf_publishers: dict[str, str] = Field(description="Authority of each frame.")
    urdf_sha256: str = Field(description="SHA-256 of the real URDF without its header comment.")
    cell_sha256: str = Field(
        "", description="SHA-256 of all else that evidence rests on; empty in manifests that were written before it."
    )


class Manifest(ContractModel):
    """Version tuple, hash of every generated file, and the configuration ID."""

    format: Literal[1] = Field(description="Version of this format.")
    cell: CellName = Field(description="Name of the cell.")
    cellc_version: str = Field(description="Release of cellc that made the folder.")
    configuration_id: str = Field(description="Id over the configuration inputs.")
    configuration_inputs: ConfigurationInputs = Field(description="What the id is taken over.")
    version_tuple: dict[str, str] = Field(description="Pinned versions by part.")
    files: dict[InnerPath, str] = Field(description="SHA-256 of every generated file but this one, by path.")
