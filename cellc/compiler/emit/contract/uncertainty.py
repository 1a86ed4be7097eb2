"""``config/uncertainty.json``: what a sweep draws, each number with unit, distribution and the statement it rests on.

Format 1, ``cellc.contract.uncertainty``. Read by ``cellc sweep``. A residual is taken for the root of the mean
square of the distance by which a frame is elsewhere, the same along each axis: an axis has a third of its square. A
bound of a clock says no more than that: every offset within it is as likely. Pose repeatability is the mean distance
from the middle of all arrivals and three standard deviations of it (ISO 9283:1998, 7.2.2); of errors that are normal
and alike along three axes that is 3.616 of their deviation. Left out: what is below a nanometer, nanoradian or
nanosecond, and what spec and catalog give no figure of, such as the error of tracking.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.uncertainty import Uncertainty as Stated
from cellc.compiler.formats.numbers import rounded
from cellc.contract.contract import ContractClock
from cellc.contract.frozen import dataclass
from cellc.contract.quantities import SMALLEST
from cellc.contract.uncertainty import WHOLE, Axis, ExpectedSuccess, Kind, UncertainQuantity, Uncertainty

_AXES: tuple[Axis, ...] = ("x", "y", "z")
_REPEATABILITY = math.sqrt(8.0 / math.pi) + 3.0 * math.sqrt(3.0 - 8.0 / math.pi)
"""Mean and three deviations of the length of a vector, each of whose three components has the deviation 1."""
_TURNS: tuple[Axis, ...] = ("rx", "ry", "rz")


@dataclass(frozen=True, slots=True)
class _Drawn:
    """A quantity, with a name that no other thing has: for where its own one is not enough."""

    quantity: UncertainQuantity
    full_name: str


def uncertainty(cell: Cell, stated: Stated, clocks: dict[str, ContractClock]) -> Uncertainty:
    """Return what sweeps of a cell draw and judge."""
    drawn = (
        *_calibrations(cell, stated),
        *_arms(cell, stated),
        *_regions(cell, stated),
        *_loads(stated),
        *_clocks(cell, clocks),
    )
    return Uncertainty(
        format=1,
        quantities=tuple(_uniquely_named([item for item in drawn if item.quantity.spread >= SMALLEST])),
        tolerances=dict(stated.tolerances_m),
        expected={
            rehearsal.name: ExpectedSuccess(success=rehearsal.success, confidence=rehearsal.confidence)
            for rehearsal in cell.rehearsals
            if rehearsal.success is not None
        },
    )


def _uniquely_named(drawn: Iterable[_Drawn]) -> Iterator[UncertainQuantity]:
    """Yield quantities under unique names: the short name, or the full one where two would share the short one."""
    drawn = tuple(drawn)
    known = Counter(item.quantity.name for item in drawn)
    alike = {item.full_name for item in drawn if known[item.quantity.name] > 1}
    for item in drawn:
        axis = "" if item.quantity.axis in WHOLE else f" {item.quantity.axis}"
        name = f"{item.full_name}{axis}" if item.full_name in alike else item.quantity.name
        yield item.quantity.model_copy(update={"name": name})


def _calibrations(cell: Cell, stated: Stated) -> Iterator[_Drawn]:
    for frame in cell.frames:
        calibration = cell.calibrations.get(frame.calibration or "")
        if calibration is None:
            continue
        names = calibration.name, f"{calibration.name} of frame {frame.name}"
        path = f"calibrations.{calibration.name}.residual"
        residual_m = calibration.residual_m or 0.0
        yield from _three("calibration", names, frame.name, (residual_m,) * 3, path)
        sigma_rad = stated.rotations_rad.get(calibration.name, 0.0)
        path = f"uncertainty.calibrations.{calibration.name}.rotation"
        yield from _three("calibration", names, frame.name, (sigma_rad,) * 3, path, turns=True)


def _arms(cell: Cell, stated: Stated) -> Iterator[_Drawn]:
    for device in cell.devices:
        path, value = f"devices.{device.name}.model", device.limits.repeatability_m
        if device.name in stated.repeatability_m:
            path, value = f"uncertainty.repeatability.{device.name}", stated.repeatability_m[device.name]
        spread = (value or 0.0) * math.sqrt(3.0) / _REPEATABILITY
        for group in cell.groups:
            if {joint.name for joint in device.joints} & set(group.joints):
                names = f"{group.name} tip", f"{group.name} tip by {device.name}"
                yield from _three("repeatability", names, group.tip_frame, (spread,) * 3, path)


def _regions(cell: Cell, stated: Stated) -> Iterator[_Drawn]:
    moving = {frame.name for frame in cell.frames if frame.simulated_pose is not None}
    for name, region in stated.regions.items():
        kind: Kind = "region" if name in moving else "place"
        # The frame itself may be calibrated.
        names = (name if name in moving else f"part at {name}"), f"object of frame {name}"
        yield from _three(kind, names, name, region.half_m, f"regions.{name}.box")
        yaw = (0.0, 0.0, region.half_yaw_rad)
        yield from _three(kind, names, name, yaw, f"regions.{name}.yaw", turns=True)


def _loads(stated: Stated) -> Iterator[_Drawn]:
    for name, spread in stated.parts_kg.items():
        yield _load("part", f"part of {name}", name, "mass", spread)
    for name, spread in stated.compensations.items():
        yield _load("compensation", f"compensation of {name}", name, "share", spread)
    for name, spread in stated.payloads_kg.items():
        yield _load("payload", f"payload of {name}", name, "mass", spread)
    for name, spread in stated.masses_kg.items():
        yield _load("mass", f"mass of {name}", name, "mass", spread, "parts")
    for name, spread in stated.frictions.items():
        yield _load("friction", f"friction of {name}", name, "friction", spread, "parts")


def _load(kind: Kind, name: str, target: str, axis: Axis, spread: float, key: str = "loads") -> _Drawn:
    quantity = UncertainQuantity.model_construct(
        name=name,
        kind=kind,
        target=target,
        axis=axis,
        unit="kg" if axis == "mass" else "1",
        distribution="normal",
        spread=rounded(spread),
        source=f"uncertainty.{key}.{target}.{kind}",
    )
    return _Drawn(quantity, f"load: {name}")


def _three(
    kind: Kind, names: tuple[str, str], target: str, spreads: tuple[float, ...], source: str, *, turns: bool = False
) -> Iterator[_Drawn]:
    for axis, spread in zip(_TURNS if turns else _AXES, spreads, strict=True):
        quantity = UncertainQuantity.model_construct(
            name=f"{names[0]} {axis}",
            kind=kind,
            target=target,
            axis=axis,
            unit="rad" if turns else "m",
            distribution="uniform" if kind in ("region", "place") else "normal" if turns else "isotropic",
            spread=rounded(spread),
            source=source,
        )
        yield _Drawn(quantity, names[1])


def _clocks(cell: Cell, clocks: dict[str, ContractClock]) -> Iterator[_Drawn]:
    for name, clock in clocks.items():
        quantity = UncertainQuantity(
            name=f"clock {name}",
            kind="clock",
            target=name,
            axis="offset",
            unit="s",
            distribution="uniform",
            spread=clock.max_offset_s or 0.0,
            source=f"hosts.{name}.clock.max_offset" if name in cell.hosts else f"devices.{name}.stamp.max_offset",
        )
        yield _Drawn(quantity, f"offset of clock {name}")
