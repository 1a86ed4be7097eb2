"""Joints of ``contract.json`` that the mock lets differ from ones that are where they were commanded at once."""

from __future__ import annotations

from pydantic import Field

from cellc.contract.base import ContractModel


class ContractSimulatedJoint(ContractModel):
    """A joint that lags, saturates or is measured with noise; rad and rad/s, or m and m/s."""

    lag_s: float = Field(0.0, description="Time constant of a first-order lag; 0 is none.")
    noise: float = Field(0.0, description="Largest error of the measured position; 0 is none.")
    max_velocity: float | None = Field(None, description="Speed at which it saturates; null where it does not.")
