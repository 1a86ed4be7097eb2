"""What sweeps draw and judge, beside what calibrations, clocks and interfaces state themselves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Vector3


@dataclass(frozen=True, slots=True, kw_only=True)
class Region:
    """Where an object may lie about its simulated pose, or a fixed frame: half edges in m, half a turn in rad."""

    half_m: Vector3
    half_yaw_rad: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Uncertainty:
    """What the spec says about it.

    Args:
        rotations_rad: calibration → standard deviation about each axis.
        regions: frame → where what lies there may lie.
        repeatability_m: arm → pose repeatability as it was measured.
        parts_kg: arm → standard deviation of the mass of the part that it holds.
        compensations: arm → standard deviation of the share of its weight that its controller compensates.
        tolerances_m: goal → farthest that the tip may really be from it.
        payloads_kg: arm → standard deviation of the mass of its tool.
        masses_kg: frame → standard deviation of the mass of the part there.
        frictions: frame → standard deviation of the friction of the part there.
    """

    rotations_rad: Mapping[str, float]
    regions: Mapping[str, Region]
    repeatability_m: Mapping[str, float]
    parts_kg: Mapping[str, float]
    compensations: Mapping[str, float]
    tolerances_m: Mapping[str, float]
    payloads_kg: Mapping[str, float] = field(default_factory=dict)
    masses_kg: Mapping[str, float] = field(default_factory=dict)
    frictions: Mapping[str, float] = field(default_factory=dict)
