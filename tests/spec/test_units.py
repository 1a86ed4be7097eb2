"""Every unit of every dimension: what one of it is in SI, and the largest value that is read, both by hand."""

from __future__ import annotations

import math

import pytest
from pydantic_core import PydanticCustomError

from cellc.compiler.spec import quantity
from cellc.compiler.spec.quantity import Dimension, Quantity, QuantityType

_TURN = math.pi / 180.0
SI: dict[str, tuple[dict[str, float], float]] = {
    "LENGTH": ({"mm": 1e-3, "cm": 1e-2, "m": 1.0, "um": 1e-6}, 1e5),
    "ANGLE": ({"deg": _TURN, "rad": 1.0}, 1e5),
    "DURATION": ({"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}, 4e9),
    "FREQUENCY": ({"Hz": 1.0, "kHz": 1e3, "MHz": 1e6}, 1e6),
    "DATA_RATE": ({"bit/s": 1.0, "kbit/s": 1e3, "Mbit/s": 1e6, "Gbit/s": 1e9}, 1e13),
    "MASS": ({"kg": 1.0, "g": 1e-3}, 1e5),
    "RATIO": ({"%": 1e-2}, 100.0),
    "DRIFT": ({"ppm": 1e-6}, 1.0),
    "FORCE": ({"N": 1.0, "kN": 1e3}, 1e6),
    "TORQUE": ({"N m": 1.0}, 1e5),
    "INERTIA": ({"kg m^2": 1.0, "g m^2": 1e-3}, 1e5),
    "VOLTAGE": ({"V": 1.0}, 1e4),
    "STIFFNESS": ({"N/m": 1.0, "N/mm": 1e3}, 1e8),
    "ANGULAR_STIFFNESS": ({"N m/rad": 1.0}, 1e8),
    "ANGULAR_DAMPING": ({"N m s/rad": 1.0}, 1e8),
    "VELOCITY": ({"m/s": 1.0, "mm/s": 1e-3}, 1e4),
    "ACCELERATION": ({"m/s^2": 1.0, "mm/s^2": 1e-3}, 1e6),
    "JERK": ({"m/s^3": 1.0, "mm/s^3": 1e-3}, 1e8),
    "ANGULAR_VELOCITY": ({"deg/s": _TURN, "rad/s": 1.0}, 1e5),
    "ANGULAR_ACCELERATION": ({"deg/s^2": _TURN, "rad/s^2": 1.0}, 1e7),
    "ANGULAR_JERK": ({"deg/s^3": _TURN, "rad/s^3": 1.0}, 1e9),
}
_LINEAR = {"LENGTH", "VELOCITY", "ACCELERATION", "JERK", "FORCE"}


def _dimension(name: str) -> Dimension:
    found = getattr(quantity, name)
    assert isinstance(found, Dimension)
    return found


def _read(name: str, text: str) -> Quantity:
    read = QuantityType((_dimension(name),), "an example").read(text)
    assert isinstance(read, Quantity)
    return read


def test_every_dimension_is_in_the_table() -> None:
    assert {name for name, one in vars(quantity).items() if isinstance(one, Dimension)} == set(SI)


@pytest.mark.parametrize("name", SI)
def test_one_of_each_unit_in_si_and_the_largest_that_is_read(name: str) -> None:
    units, largest = SI[name]
    assert {unit: _read(name, f"1 {unit}").si for unit, _ in _dimension(name).units} == pytest.approx(units, rel=1e-15)
    for unit, factor in units.items():
        read = _read(name, f"-0.25 {unit}")
        assert read.si == pytest.approx(-0.25 * factor)
        assert (read.unit, read.linear) == (unit, name in _LINEAR)
    one = next(unit for unit, factor in units.items() if factor == max(units.values()))
    count = largest / units[one]
    for sign in (1.0, -1.0):
        assert _read(name, f"{sign * count * (1.0 - 1e-9):.12g} {one}").si == pytest.approx(sign * largest, rel=1e-8)
        with pytest.raises(PydanticCustomError, match="must be between"):
            _read(name, f"{sign * count * (1.0 + 1e-9):.12g} {one}")


def test_decimal_values_are_the_nearest_to_what_was_written() -> None:
    assert (_read("LENGTH", "162 mm").si, _read("LENGTH", "0.1 cm").si) == (0.162, 0.001)
