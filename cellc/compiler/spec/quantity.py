"""Quantities as users write them: a number, or several, with the unit in the text.

``500 Hz``, ``0.2 s``, ``0 0 162 mm``, ``0 -90 90 deg``, ``50 %``. A bare number is an error that tells which units fit.
Values are held in SI and radians (REP-103) beside the text, so that a message can quote what the user wrote.

Every kind of quantity has its bounds, so that nothing after this meets a rate of zero or a length that overflows. They
are far beyond any cell: what is merely wrong for one is for rules to say.
"""

from __future__ import annotations

import math
import re
from decimal import Decimal
from typing import Annotated, Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from cellc.contract.frozen import dataclass

# Two digits of exponent: nothing in a cell is 1e100, and no factor then takes a value past the range of a double.
_NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]{1,2})?"
_SPACE = r" \t\r\n"
_NOT_NEGATIVE = r"(?:\+?(?:[0-9]+\.?[0-9]*|\.[0-9]+)|-(?:0+\.?0*|\.0+))(?:[eE][-+]?[0-9]{1,2})?"
"""The same where a figure cannot be below zero."""
_NUMBERS = rf"{_NUMBER}(?:[{_SPACE},]+{_NUMBER})*"
_NUMBERS_THEN_UNIT = re.compile(rf"[{_SPACE}]*({_NUMBERS})[{_SPACE}]*([^{_SPACE}0-9].*?)?[{_SPACE}]*", re.ASCII)
_ONE_OF_SEVERAL = re.compile(
    rf"[{_SPACE}]*({_NUMBERS}[{_SPACE}]*[^{_SPACE}0-9,.+-][^{_SPACE},]*)(?:[{_SPACE},]+|$)", re.ASCII
)
_MAX_TEXT = 400  # a pose of 20 joints is under 200 characters; more is no quantity


@dataclass(frozen=True, slots=True)
class Dimension:
    """A physical dimension with the units that users may write, each with its factor to SI.

    ``deg`` is the one factor that no decimal holds; it is applied by ``math.radians``. ``largest`` is the greatest
    magnitude in SI.
    """

    name: str
    units: tuple[tuple[str, Decimal | None], ...]
    largest: float


def _dimension(name: str, units: dict[str, str | None], largest: float) -> Dimension:
    return Dimension(name, tuple((unit, None if si is None else Decimal(si)) for unit, si in units.items()), largest)


LENGTH = _dimension("length", {"mm": "0.001", "cm": "0.01", "m": "1", "um": "0.000001"}, 1e5)
ANGLE = _dimension("angle", {"deg": None, "rad": "1"}, 1e5)
DURATION = _dimension(
    "duration", {"s": "1", "ms": "0.001", "us": "0.000001", "ns": "0.000000001", "min": "60", "h": "3600"}, 4e9
)
FREQUENCY = _dimension("frequency", {"Hz": "1", "kHz": "1000", "MHz": "1000000"}, 1e6)
DATA_RATE = _dimension("data rate", {"bit/s": "1", "kbit/s": "1000", "Mbit/s": "1000000", "Gbit/s": "1000000000"}, 1e13)
MASS = _dimension("mass", {"kg": "1", "g": "0.001"}, 1e5)
RATIO = _dimension("ratio", {"%": "0.01"}, 100.0)
DRIFT = _dimension("clock drift", {"ppm": "0.000001"}, 1.0)
FORCE = _dimension("force", {"N": "1", "kN": "1000"}, 1e6)
TORQUE = _dimension("torque", {"N m": "1"}, 1e5)
INERTIA = _dimension("inertia", {"kg m^2": "1", "g m^2": "0.001"}, 1e5)
VOLTAGE = _dimension("voltage", {"V": "1"}, 1e4)
STIFFNESS = _dimension("stiffness", {"N/m": "1", "N/mm": "1000"}, 1e8)
ANGULAR_STIFFNESS = _dimension("angular stiffness", {"N m/rad": "1"}, 1e8)
ANGULAR_DAMPING = _dimension("angular damping", {"N m s/rad": "1"}, 1e8)
VELOCITY = _dimension("velocity", {"m/s": "1", "mm/s": "0.001"}, 1e4)
ACCELERATION = _dimension("acceleration", {"m/s^2": "1", "mm/s^2": "0.001"}, 1e6)
JERK = _dimension("jerk", {"m/s^3": "1", "mm/s^3": "0.001"}, 1e8)
ANGULAR_VELOCITY = _dimension("angular velocity", {"deg/s": None, "rad/s": "1"}, 1e5)
ANGULAR_ACCELERATION = _dimension("angular acceleration", {"deg/s^2": None, "rad/s^2": "1"}, 1e7)
ANGULAR_JERK = _dimension("angular jerk", {"deg/s^3": None, "rad/s^3": "1"}, 1e9)
_LINEAR = frozenset(unit for dimension in (LENGTH, VELOCITY, ACCELERATION, JERK, FORCE) for unit, _ in dimension.units)


@dataclass(frozen=True, slots=True)
class Quantity:
    """One value: ``si`` in SI units and radians, ``unit`` and ``text`` as written."""

    si: float
    unit: str
    text: str

    @property
    def linear(self) -> bool:
        """Whether it is a length, what a length does in time, or a force."""
        return self.unit in _LINEAR


@dataclass(frozen=True, slots=True)
class QuantityVector:
    """Several values: ``si`` in SI units and radians, ``units`` of each and ``text`` as written."""

    si: tuple[float, ...]
    units: tuple[str, ...]
    text: str

    @property
    def linear(self) -> tuple[bool, ...]:
        """Whether each value is a length."""
        return tuple(unit in _LINEAR for unit in self.units)


@dataclass(frozen=True, slots=True)
class QuantityType:
    """Tells pydantic how a field reads its text; ``size`` is 1, a fixed count, or 0 for any count.

    ``least`` and ``most`` are bounds in SI, those of the dimension where they are None. ``mixed`` where values of
    another unit may follow, as in ``400 mm 0 -90 deg``: a unit is that of all numbers before it that have none.
    """

    dimensions: tuple[Dimension, ...]
    example: str
    size: int = 1
    least: float | None = None
    most: float | None = None
    mixed: bool = False

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self.read, serialization=core_schema.plain_serializer_function_ser_schema(_written)
        )

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        written = self._written(self.dimensions)
        if self.mixed and self.size == 1:
            first, second = (self._written((dimension,)) for dimension in self.dimensions)
            written = rf"(?:{first}(?:[{_SPACE},]+{second})?|{second}(?:[{_SPACE},]+{first})?)"
        elif self.mixed:
            written += rf"(?:[{_SPACE},]+{written})*"
        pattern = rf"^[{_SPACE}]*{written}[{_SPACE}]*$"
        return {"type": "string", "pattern": pattern, "maxLength": _MAX_TEXT, "x-units": list(self.units())}

    def _written(self, dimensions: tuple[Dimension, ...]) -> str:
        """Return the pattern of numbers with one unit of some dimensions."""
        more = {0: "*", 1: "{0}"}.get(self.size, f"{{{self.size - 1}}}")
        units = "|".join(re.escape(unit).replace("\\ ", " ") for dimension in dimensions for unit, _ in dimension.units)
        number = _NUMBER if self.least is None or self.least < 0.0 else _NOT_NEGATIVE
        return rf"{number}(?:[{_SPACE},]+{number}){more}[{_SPACE}]*(?:{units})"

    def units(self) -> tuple[str, ...]:
        """List the units that fit, in the order of the dimensions."""
        return tuple(unit for dimension in self.dimensions for unit, _ in dimension.units)

    def read(self, value: object) -> Quantity | QuantityVector:
        """Return what a user wrote as a quantity.

        Raises:
            PydanticCustomError: the value is no quantity, or has another dimension.
        """
        if isinstance(value, (Quantity, QuantityVector)):
            return value
        if isinstance(value, bool) or not isinstance(value, (str, int, float)):
            raise PydanticCustomError("not-a-quantity", "expected {what}, such as `{example}`", self._context())
        if not isinstance(value, str):
            raise self._missing_unit(str(value))
        if self.mixed:
            return self._joined(value, _parts(value))
        read = self._convert(value, *self._split(value))
        return Quantity(read.si[0], read.units[0], value) if self.size == 1 else read

    def _split(self, text: str) -> tuple[list[str], str | None]:
        match = _NUMBERS_THEN_UNIT.fullmatch(text) if len(text) <= _MAX_TEXT else None
        if match is None:
            context = self._context() | {"text": text[:60]}
            raise PydanticCustomError("not-a-quantity", "`{text}` is not {what}, such as `{example}`", context)
        return re.split(r"[\s,]+", match[1]), match[2]

    def _joined(self, text: str, parts: list[str]) -> QuantityVector:
        read = [self._convert(text, *self._split(part)) for part in parts]
        kinds = [linear for vector in read for linear in vector.linear]
        if self.size == 1 and len(set(kinds)) < len(kinds):
            context = self._context() | {"what": "an angle, a length, or one of each"}
            raise PydanticCustomError("not-a-quantity", "expected {what}, such as `{example}`", context)
        si = tuple(value for vector in read for value in vector.si)
        return QuantityVector(si, tuple(unit for vector in read for unit in vector.units), text)

    def _convert(self, text: str, numbers: list[str], unit: str | None) -> QuantityVector:
        if unit is None:
            raise self._missing_unit(text)
        factors = {name: factor for dimension in self.dimensions for name, factor in dimension.units}
        if unit not in factors:
            context = self._context() | {"unit": unit}
            raise PydanticCustomError("wrong-unit", "`{unit}` is not a unit of {what}", context)
        if self.size and len(numbers) != self.size:
            context = self._context() | {"actual": len(numbers), "size": self.size}
            raise PydanticCustomError("wrong-count", "expected {size} numbers, got {actual}", context)
        values = tuple(_scaled(number, factors[unit]) for number in numbers)
        least, most = self._bounds(unit)
        if not all(least <= value <= most for value in values):  # what is not finite neither
            bounds = f"between {_shown(least, factors[unit])} and {_shown(most, factors[unit])} {unit}"
            context = {"bounds": bounds, "text": text[:60]}
            raise PydanticCustomError("quantity-out-of-range", "must be {bounds}, got `{text}`", context)
        return QuantityVector(values, (unit,) * len(values), text)

    def _bounds(self, unit: str) -> tuple[float, float]:
        largest = next(dimension.largest for dimension in self.dimensions if unit in dict(dimension.units))
        return (-largest if self.least is None else self.least, largest if self.most is None else self.most)

    def _missing_unit(self, text: str) -> PydanticCustomError:
        context = self._context() | {"text": text[:60]}
        return PydanticCustomError("missing-unit", "`{text}` carries no unit", context)

    def _context(self) -> dict[str, Any]:
        names = " or ".join(dimension.name for dimension in self.dimensions)
        article = "an" if names[0] in "aeiou" else "a"
        return {"what": f"{article} {names}", "units": ", ".join(self.units()), "example": self.example}


def spaced(text: str) -> str:
    """Return a quantity with one space between its numbers and before its unit; each number and unit stays as it is.

    A text that is no quantity stays as a whole.
    """
    numbers = [_NUMBERS_THEN_UNIT.fullmatch(part) for part in _parts(text)] if len(text) <= _MAX_TEXT else []
    matches = [match for match in numbers if match is not None and match[2]]
    if not matches or len(matches) < len(numbers):
        return text
    return " ".join(" ".join((*re.split(r"[\s,]+", match[1]), *match[2].split())) for match in matches)


def _parts(text: str) -> list[str]:
    """Split a text of several units into numbers with their unit; it stays whole where it cannot be split."""
    parts: list[str] = []
    at, end = 0, len(text.rstrip(" \t\r\n"))
    while len(text) <= _MAX_TEXT and (match := _ONE_OF_SEVERAL.match(text, at)):
        parts.append(match[1])
        at = match.end()
    return parts if at >= end and parts else [text]


def _scaled(number: str, factor: Decimal | None) -> float:
    # Decimal keeps `162 mm` at 0.162, not 0.16200000000000001, wherever the shortest text is written again.
    return math.radians(float(number)) if factor is None else float(Decimal(number) * factor)


def _shown(si: float, factor: Decimal | None) -> str:
    """Write a bound in the unit that the user chose, without exponent where it is large."""
    value = math.degrees(si) if factor is None else float(Decimal(str(si)) / factor)
    return f"{value:.0f}" if abs(value) >= 100.0 else f"{value:g}"


def _written(value: Quantity | QuantityVector) -> str:
    return value.text


LONGEST_S = 1e6  # eleven days: no budget, timeout or step of a cell is longer
SLOWEST_HZ = 1e-4  # once in three hours; the mock plays nothing slower

Length = Annotated[Quantity, QuantityType((LENGTH,), "162 mm", least=0.0)]
# Of a surface that points were read on: what is farther away is not on it.
Fit = Annotated[Quantity, QuantityType((LENGTH,), "2 mm", least=0.0, most=0.05)]
Way = Annotated[Quantity, QuantityType((LENGTH,), "-6 mm")]
# What is divided by, or stepped in: a map of cells without an edge, a loop without a period, has no end.
Edge = Annotated[Quantity, QuantityType((LENGTH,), "25 mm", least=1e-3)]
# Of a tip: zero is exceeded by the last bit of a sum, and no arm is distinguished finer than this.
Allowance = Annotated[Quantity, QuantityType((LENGTH,), "5 mm", least=1e-6)]
Period = Annotated[Quantity, QuantityType((DURATION,), "4 ms", least=1e-4, most=1.0)]
Duration = Annotated[Quantity, QuantityType((DURATION,), "200 ms", least=0.0, most=LONGEST_S)]
# A wait that zero would end before it begins.
PositiveDuration = Annotated[Quantity, QuantityType((DURATION,), "200 ms", least=1e-6, most=LONGEST_S)]
# Ahead or behind: a clock without a battery starts in 1970. Where a length of time has this type, a rule judges it.
TimeShift = Annotated[Quantity, QuantityType((DURATION,), "-1.5 ms")]
Frequency = Annotated[Quantity, QuantityType((FREQUENCY,), "500 Hz", least=SLOWEST_HZ)]
# ros2_control, controller_manager: an integer in Hz.
UpdateRate = Annotated[Quantity, QuantityType((FREQUENCY,), "500 Hz", least=1.0)]
DataRate = Annotated[Quantity, QuantityType((DATA_RATE,), "1 Gbit/s", least=1.0)]
Mass = Annotated[Quantity, QuantityType((MASS,), "0.9 kg", least=0.0)]
Ratio = Annotated[Quantity, QuantityType((RATIO,), "50 %")]
Share = Annotated[Quantity, QuantityType((RATIO,), "100 %", least=0.0, most=1.0)]
# Of what may move at all: a cap of nothing lets nothing move.
Cap = Annotated[Quantity, QuantityType((RATIO,), "50 %", least=0.001)]
SpeedCap = Annotated[Quantity, QuantityType((VELOCITY, RATIO), "250 mm/s", least=0.001)]
Stages = Annotated[QuantityVector, QuantityType((RATIO,), "10 25 50 100 %", size=0, least=0.01, most=1.0)]
# No number of runs shows that all succeed: one in a million may fail, which ten million runs can tell.
Rate = Annotated[Quantity, QuantityType((RATIO,), "99.5 %", least=0.0, most=0.999999)]
Confidence = Annotated[Quantity, QuantityType((RATIO,), "95 %", least=0.5, most=0.9999)]
Drift = Annotated[Quantity, QuantityType((DRIFT,), "20 ppm")]
Force = Annotated[Quantity, QuantityType((FORCE,), "60 N", least=0.0)]
Velocity = Annotated[Quantity, QuantityType((VELOCITY,), "0.25 m/s", least=0.0)]
Voltage = Annotated[Quantity, QuantityType((VOLTAGE,), "24 V", least=0.0)]
Forces = Annotated[QuantityVector, QuantityType((FORCE,), "30 30 30 N", size=3, least=0.0)]
Moments = Annotated[QuantityVector, QuantityType((TORQUE,), "25 25 25 N m", size=3, least=0.0)]
JointTorques = Annotated[QuantityVector, QuantityType((TORQUE,), "25 25 22 20 19 17 14 N m", size=0, least=0.0)]
Inertia = Annotated[QuantityVector, QuantityType((INERTIA,), "0.0011 0.0011 0.0009 0 0 0 kg m^2", size=6)]
JointInertias = Annotated[
    QuantityVector, QuantityType((INERTIA,), "0.2 0.2 0.2 0.2 0.07 0.07 0.07 kg m^2", size=0, least=0.0)
]
Stiffnesses = Annotated[QuantityVector, QuantityType((STIFFNESS,), "3000 3000 3000 N/m", size=3, least=0.0)]
AngularStiffnesses = Annotated[
    QuantityVector, QuantityType((ANGULAR_STIFFNESS,), "300 300 300 N m/rad", size=3, least=0.0)
]
JointStiffnesses = Annotated[
    QuantityVector, QuantityType((ANGULAR_STIFFNESS,), "3000 3000 3000 2500 2500 2000 2000 N m/rad", size=0, least=0.0)
]
JointDampings = Annotated[
    QuantityVector, QuantityType((ANGULAR_DAMPING,), "2.75 2.5 2 2 0.7 0.6 0.5 N m s/rad", size=0, least=0.0)
]
JointPosition = Annotated[Quantity, QuantityType((ANGLE, LENGTH), "0.2 rad")]
JointVelocity = Annotated[Quantity, QuantityType((ANGULAR_VELOCITY, VELOCITY), "30 deg/s")]
# Of what moves: nothing takes time without end.
JointSpeed = Annotated[Quantity, QuantityType((ANGULAR_VELOCITY, VELOCITY), "30 deg/s", least=1e-6)]
JointWay = Annotated[Quantity, QuantityType((ANGLE, LENGTH), "5 deg", least=1e-6)]
JointEffort = Annotated[Quantity, QuantityType((TORQUE, FORCE), "10 N m", least=0.0)]
JointAcceleration = Annotated[Quantity, QuantityType((ANGULAR_ACCELERATION, ACCELERATION), "2 rad/s^2", least=1e-6)]
JointJerk = Annotated[Quantity, QuantityType((ANGULAR_JERK, JERK), "20 rad/s^3", least=1e-6)]
JointPositions = Annotated[QuantityVector, QuantityType((ANGLE, LENGTH), "0 -90 90 -90 -90 0 deg", size=0, mixed=True)]
# One figure for joints that turn, one for joints that slide, or both.
JointTolerances = Annotated[QuantityVector, QuantityType((ANGLE, LENGTH), "0.2 rad", mixed=True)]
Sides = Annotated[QuantityVector, QuantityType((LENGTH,), "40 77 60 mm", size=3, least=1e-3)]
"""Of a body, which has an extent each way."""
Edges = Annotated[QuantityVector, QuantityType((LENGTH,), "80 120 0 mm", size=3, least=0.0)]
Position = Annotated[QuantityVector, QuantityType((LENGTH,), "0 0 162 mm", size=3)]
# One turn, rounded as people write it: more is an angle in degrees that is read in radians.
_TURN = 6.3
FieldAngle = Annotated[Quantity, QuantityType((ANGLE,), "69 deg", least=0.0, most=_TURN)]
RollPitchYaw = Annotated[QuantityVector, QuantityType((ANGLE,), "0 90 0 deg", size=3, least=-_TURN, most=_TURN)]


# Unit of the spec → other spellings, in lower case. Left out: `mhz`, which may be a millihertz, and `min` for minute of
# arc; a prefix is never guessed.
_SPELLINGS = {
    "Hz": ("hz", "hertz", "1/s"),
    "kHz": ("khz", "kilohertz"),
    "s": ("sec", "secs", "second", "seconds"),
    "ms": ("msec", "msecs", "millisecond", "milliseconds"),
    "us": ("usec", "µs", "μs", "microsecond", "microseconds"),
    "min": ("minute", "minutes"),
    "h": ("hour", "hours", "hr"),
    "deg": ("degree", "degrees", "°"),
    "rad": ("radian", "radians"),
    "mm": ("millimeter", "millimeters", "millimetre", "millimetres"),
    "cm": ("centimeter", "centimeters", "centimetre", "centimetres"),
    "m": ("meter", "meters", "metre", "metres"),
    "kg": ("kilogram", "kilograms", "kgs"),
    "g": ("gram", "grams"),
    "%": ("percent", "pct"),
    "N": ("newton", "newtons"),
    "deg/s": ("deg/sec", "degrees/s", "°/s"),
    "rad/s": ("rad/sec", "radians/s"),
    "m/s": ("m/sec",),
    "mm/s": ("mm/sec",),
}
UNIT_OF_SPELLING = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings}
