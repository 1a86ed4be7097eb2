"""Adapters of ``contract.json``: devices that their vendor's library drives."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from cellc.contract.base import ContractModel


class ContractAdapter(ContractModel):
    """A device that its vendor's library drives behind an adapter, where no controller does."""

    joints: tuple[str, ...] = Field(description="Joints in the order of states and commands.")
    units: tuple[Literal["rad", "m"], ...] = Field(description="Unit of each joint's position.")
    action: str = Field(description="Full name of the action that takes its trajectories.")
    state_topic: str = Field(description="Full name of the topic of its stamped state.")
    client: str | None = Field(None, description="Name of the one node that may command it.")
    command_period_s: float = Field(description="Time from one command to the next.", gt=0.0)
    command_timeout_s: float = Field(description="Watchdog: silence after which it stops.", gt=0.0)
    stop_time_s: float = Field(description="Longest time from a hold to standstill.", gt=0.0)
    goal_time_s: float = Field(description="Time past the end of a trajectory within which it stands still.", gt=0.0)
    path_tolerance: float = Field(description="Distance from the command that ends a goal, rad or m.", gt=0.0)
    start_positions: tuple[float, ...] = Field(description="Where the mock's joints stand at first, rad or m.")
