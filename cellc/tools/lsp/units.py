"""A value with a unit in the other units that people read it in: 0.01 rad is 0.573 deg, 500 Hz is every 2 ms."""

from __future__ import annotations

import math
from collections.abc import Mapping

from cellc.compiler.spec.quantity import Quantity, QuantityVector

_TURNING = 180.0 / math.pi
# Written unit → the units it is shown in, each with how many of it are one of SI.
_SHOWN: Mapping[str, tuple[tuple[str, float], ...]] = {
    **dict.fromkeys(("rad", "deg"), (("deg", _TURNING), ("rad", 1.0))),
    **dict.fromkeys(("rad/s", "deg/s"), (("deg/s", _TURNING), ("rad/s", 1.0))),
    **dict.fromkeys(("rad/s^2", "deg/s^2"), (("deg/s^2", _TURNING), ("rad/s^2", 1.0))),
    **dict.fromkeys(("rad/s^3", "deg/s^3"), (("deg/s^3", _TURNING), ("rad/s^3", 1.0))),
    **dict.fromkeys(("mm", "cm", "m", "um"), (("m", 1.0), ("mm", 1e3))),
    **dict.fromkeys(("m/s", "mm/s"), (("m/s", 1.0), ("mm/s", 1e3))),
    **dict.fromkeys(("m/s^2", "mm/s^2"), (("m/s^2", 1.0), ("mm/s^2", 1e3))),
    **dict.fromkeys(("m/s^3", "mm/s^3"), (("m/s^3", 1.0), ("mm/s^3", 1e3))),
    **dict.fromkeys(("ms", "us", "ns", "min", "h"), (("s", 1.0),)),
    **dict.fromkeys(("kHz", "MHz"), (("Hz", 1.0),)),
    **dict.fromkeys(("kbit/s", "Mbit/s", "Gbit/s"), (("bit/s", 1.0),)),
    **dict.fromkeys(("N", "kN"), (("N", 1.0), ("kN", 1e-3))),
    **dict.fromkeys(("N/m", "N/mm"), (("N/m", 1.0), ("N/mm", 1e-3))),
    **dict.fromkeys(("kg", "g"), (("kg", 1.0), ("g", 1e3))),
    "g m^2": (("kg m^2", 1.0),),
    "N m/rad": (("N m/deg", math.pi / 180.0),),
}


def in_other_units(read: Quantity | QuantityVector) -> tuple[str, ...]:
    """Return a value in each other unit that is usual for it; nothing where it has none."""
    values, units = (read.si, read.units) if isinstance(read, QuantityVector) else ((read.si,), (read.unit,))
    if len(set(units)) != 1:
        return (" ".join(_in(_SHOWN.get(unit, ()), unit, (value,)) for value, unit in zip(values, units, strict=True)),)
    shown = tuple(_written(values, unit, factor) for unit, factor in _SHOWN.get(units[0], ()) if unit != units[0])
    is_rate = units[0] in ("Hz", "kHz", "MHz") and values[0] > 0.0
    return (*shown, f"every {in_words(1.0 / values[0])}") if is_rate else shown


def _in(shown: tuple[tuple[str, float], ...], written: str, values: tuple[float, ...]) -> str:
    return next((_written(values, unit, factor) for unit, factor in shown if unit != written), "")


def _written(values: tuple[float, ...], unit: str, factor: float) -> str:
    return f"{' '.join(f'{value * factor + 0.0:.3g}' for value in values)} {unit}"


def in_words(seconds: float) -> str:
    """Return a time in seconds, or in milliseconds where it is short."""
    return f"{seconds:.3g} s" if seconds >= 1.0 else f"{seconds * 1e3:.3g} ms"


def of_a_joint(figure: float, what: str, *, slides: bool) -> str:
    """Return a figure of a joint in the units of the spec: degrees, or millimeters where it slides.

    Args:
        what: what the figure is per: nothing for a position, ``/s`` for a velocity.
    """
    return f"{figure * 1e3:.4g} mm{what}" if slides else f"{figure * _TURNING:.4g} deg{what}"
