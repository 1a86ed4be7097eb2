"""The network of ``contract.json``, as the mock carries a topic over it."""

from __future__ import annotations

from pydantic import Field

from cellc.contract.base import ContractModel


class ContractNetwork(ContractModel):
    """What the mock's network does to each sample of a topic."""

    latency_s: float = Field(0.0, description="Shortest time from publishing to arrival.")
    jitter_s: float = Field(0.0, description="Up to so much more.")
    loss: float = Field(0.0, description="Share of samples lost on their way, 0 to 1.")
    reordering: float = Field(0.0, description="Share of samples overtaken by the next one, 0 to 1.")
