"""Targets that the evidence is held against, and what is recorded."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from cellc.spec.base import SpecModel, StandardOr, Text
from cellc.spec.quantity import Duration, Ratio


class KpisSpec(SpecModel):
    """The key figures of the checkpoint; one without a target is a warning."""

    plan_to_execute: Duration | None = Field(
        None, description="Longest time from plan to execution.", examples=["500 ms"]
    )
    cancel: Duration | None = Field(None, description="Longest time from cancel to hold.", examples=["200 ms"])
    missed_cycles: int | None = Field(None, description="Missed update cycles allowed in a run.", examples=[0], ge=0)
    stale_state_rejection: Ratio | None = Field(
        None, description="Share of stale samples rejected.", examples=["100 %"]
    )
    protective_stops: int | None = Field(None, description="Protective stops allowed in a shift.", examples=[0], ge=0)
    recovery_time: Duration | None = Field(None, description="Longest time from stop to ready.", examples=["120 s"])
    wrong_owner_events: int | None = Field(None, description="Commands of a wrong owner allowed.", examples=[0], ge=0)


class RecordingSpec(SpecModel):
    """What every attempt leaves behind."""

    attempt_fields: StandardOr = Field(
        "standard", description="`standard` for all fields of the checkpoint, or their names.", examples=["standard"]
    )
    topics: tuple[Text, ...] = Field(
        (), description="Topics to record beyond those of the motion path.", examples=[["/diagnostics"]]
    )


class TargetSpec(SpecModel):
    """What differs between mock, simulation and the real cell."""

    hardware: Literal["mock", "sim", "real"] | None = Field(
        None, description="Hardware components used; that of the target's name if absent.", examples=["mock"]
    )
    clock: Literal["wall", "sim"] | None = Field(
        None, description="Time of every node of the target.", examples=["wall"]
    )
