"""Clocks of ``contract.json``: what stamps are made on, and how the mock lets it be off."""

from __future__ import annotations

from pydantic import Field

from cellc.contract.base import ContractModel


class ContractClock(ContractModel):
    """A clock that stamps are made on: of a host, or of a device with one of its own."""

    domain: str = Field(description="Clock domain.")
    synchronised_by: str | None = Field(None, description="What disciplines it.")
    max_offset_s: float | None = Field(None, description="Bound of its offset; null where nothing bounds it.")
    simulated: bool = Field(False, description="Time comes from /clock.")
    offset_s: float = Field(0.0, description="Offset that the mock gives it.")
    drift: float = Field(0.0, description="Seconds that the mock lets it gain in a second, until the bound.")
