"""The kinds of numbers in the files between compiler and mock, and what each kind may be where a folder is read.

The compiler writes what its rules let through, and these types let it: nothing is checked where a model is built. Who
reads an untrusted folder validates with ``context=limits()``, and nothing past that door asks again whether a rate
is above zero or a duration can be counted in nanoseconds.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, TypeVar

from pydantic import AfterValidator, ValidationInfo
from pydantic_core import PydanticCustomError

from cellc.contract.frozen import dataclass
from cellc.contract.limits import Limits

LARGEST = 1e9
"""Of lengths, angles, speeds and forces, SI. No machine has more, and products of such values stay finite."""
SMALLEST = 1e-9
"""Of what something moves with, SI, and of what is divided by; a nanosecond is the step of the mock's clock."""

_UNIT_TOLERANCE = 1e-3

_Number = TypeVar("_Number", int, float)
_Bound = Callable[[Limits], float]


@dataclass(frozen=True, slots=True)
class _Range:
    """What a number of one kind may be, under the limits in force.

    Args:
        unit: after the figures of the message; empty where fields of one kind have several.
    """

    least: float | _Bound
    most: float | _Bound
    unit: str = ""

    def __call__(self, value: _Number, info: ValidationInfo) -> _Number:
        """Return a value of this kind, or refuse it where a folder is read."""
        if not isinstance(info.context, Limits):
            return value
        least = self.least(info.context) if callable(self.least) else self.least
        most = self.most(info.context) if callable(self.most) else self.most
        if not least <= value <= most:
            text = f"must be from {least:.15g} to {most:.15g}{self.unit and f' {self.unit}'}, got {value:g}"
            raise PydanticCustomError("out-of-range", "{text}", {"text": text})
        return value


def _check_unit(value: tuple[float, ...], info: ValidationInfo) -> tuple[float, ...]:
    length = math.hypot(*value)
    if isinstance(info.context, Limits) and not abs(length - 1.0) <= _UNIT_TOLERANCE:
        text = f"must be a unit quaternion, got one of length {length:g}"
        raise PydanticCustomError("out-of-range", "{text}", {"text": text})
    return value


def _longest(limits: Limits) -> float:
    return limits.mock_seconds


def _fastest(limits: Limits) -> float:
    return limits.mock_rate


def _shortest(limits: Limits) -> float:
    return 1.0 / limits.mock_rate


Seconds = Annotated[float, AfterValidator(_Range(0.0, _longest, "s"))]
"""A duration or an age."""
PositiveSeconds = Annotated[float, AfterValidator(_Range(SMALLEST, _longest, "s"))]
"""A bound that zero would make meaningless."""
Period = Annotated[float, AfterValidator(_Range(_shortest, _longest, "s"))]
"""Time from one to the next."""
Offset = Annotated[float, AfterValidator(_Range(lambda of: -_longest(of), _longest, "s"))]
"""A difference of times."""
Drift = Annotated[float, AfterValidator(_Range(-0.5, 0.5))]
"""Seconds that a clock gains in a second."""
Rate = Annotated[float, AfterValidator(_Range(1e-4, _fastest, "Hz"))]
"""How often a second."""
Share = Annotated[float, AfterValidator(_Range(0.0, 1.0))]
"""From none to all."""
Coordinate = Annotated[float, AfterValidator(_Range(-LARGEST, LARGEST))]
"""A position or an offset, m or rad."""
Magnitude = Annotated[float, AfterValidator(_Range(0.0, LARGEST))]
"""A distance, an effort or another size, where zero says none."""
PositiveMagnitude = Annotated[float, AfterValidator(_Range(SMALLEST, LARGEST))]
"""A speed, an acceleration or a jerk that something moves with."""
Count = Annotated[int, AfterValidator(_Range(0, 2**31 - 1))]
"""How many; a spec may state as many."""
Pixels = Annotated[int, AfterValidator(_Range(1, 100_000))]
"""Edge of an image."""
UnitQuaternion = Annotated[tuple[float, float, float, float], AfterValidator(_check_unit)]
"""A rotation x, y, z, w."""
