"""``config/uncertainty.json``: what a sweep draws in each run, what it judges, and what must come of it."""

from typing import Literal

from pydantic import Field

from cellc.contract.base import ContractModel
from cellc.contract.quantities import Magnitude, PositiveMagnitude

UNCERTAINTY_FILE = "config/uncertainty.json"
"""Beside the contract; a cell that says nothing of uncertainty has none."""


Kind = Literal[
    "calibration", "repeatability", "place", "region", "clock", "part", "compensation", "payload", "mass", "friction"
]
Axis = Literal["x", "y", "z", "rx", "ry", "rz", "offset", "mass", "share", "friction"]
WHOLE: tuple[Axis, ...] = ("offset", "mass", "share", "friction")
"""What is no axis: a thing has one of it."""
OF_MASSES: tuple[Kind, ...] = ("payload", "mass", "friction")
"""What a run has only where bodies have masses."""


class UncertainQuantity(ContractModel):
    """One random number, drawn for each run: m for (x, y, z), rad for (rx, ry, rz), s, kg, 1, 1 for (offset, mass,
    share, friction).

    ``calibration``: real offset of frame ``target`` along or about one of its own axes. ``place``: the same for an
    object that no camera observes. ``repeatability``: the same for the tip of an arm. Several of one frame add up.
    ``region``: offset of the object that frame ``target`` follows, along or about an axis of the parent of its
    simulated pose. ``clock``: offset of the reading of clock ``target``. ``part``: how much heavier the part
    is that the tool of device ``target`` holds. ``compensation``: share of its weight by which device ``target``
    compensates too much. With ``--physics`` alone: ``payload``: how much heavier the tool of device ``target`` is than
    its controller knows. ``mass``, ``friction``: how much heavier the part at frame ``target`` is, and how much more
    friction its surface has.
    """

    name: str = Field(description="Name in reports.")
    kind: Kind = Field(description="What it displaces.")
    target: str = Field(description="Frame, clock or device.")
    axis: Axis = Field(description="Axis; offset of a clock, mass, share of a weight, or friction.")
    unit: Literal["m", "rad", "s", "kg", "1"] = Field(description="Unit of the spread.")
    distribution: Literal["normal", "isotropic", "uniform"] = Field(
        description="How it is drawn, about zero; isotropic is normal, and alike along three axes."
    )
    spread: PositiveMagnitude = Field(
        description="Standard deviation, or that of the three axes together; half the range of a uniform one."
    )
    source: str = Field(description="Path in the spec of what it is drawn by.")


class ExpectedSuccess(ContractModel):
    """What share of the runs of a rehearsal must succeed, and how sure a verdict must be."""

    success: Magnitude = Field(description="Least share, 0 to 1.", le=1.0)
    confidence: Magnitude = Field(description="Confidence of the verdict, 0 to 1.", ge=0.5, lt=1.0)


class Uncertainty(ContractModel):
    """Everything that a sweep of a cell needs beside the contract."""

    format: Literal[1] = Field(description="Version of this format.")
    quantities: tuple[UncertainQuantity, ...] = Field(description="What each run draws.")
    tolerances: dict[str, PositiveMagnitude] = Field(
        description="Goal → farthest that the tip may really be from where the goal really is, m."
    )
    expected: dict[str, ExpectedSuccess] = Field(description="Rehearsal → what must come of its runs.")
