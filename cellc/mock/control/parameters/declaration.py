"""Parameters of a node: values with their types, declarations, and what is required of a value."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping

from cellc.contract.errors import ReasonError
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.mock.errors import LimitReachedError

ParameterValue = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]

_TRUE = ("Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON")
_FALSE = ("N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF")
_INTEGER = re.compile(r"[-+]?(0[xX][0-9a-fA-F]+|[0-9]+)")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_LONGEST_INTEGER = 40
_SLOWEST_HZ = 1e-4
_SPECIAL = {".inf": math.inf, "+.inf": math.inf, "-.inf": -math.inf, ".nan": math.nan}


def _integer(text: str) -> int:
    """Read an integer as strtol does with base 0: a leading 0 means octal."""
    sign = -1 if text.startswith("-") else 1
    digits = text.lstrip("+-")
    if digits[:2] in ("0x", "0X"):
        return sign * int(digits, 16)
    if len(digits) > 1 and digits[0] == "0" and all(digit in "01234567" for digit in digits):
        return sign * int(digits, 8)
    return sign * int(digits)


def scalar(text: str, quoted: bool) -> bool | int | float | str:
    """Type a plain YAML scalar.

    Args:
        text: the scalar as written.
        quoted: whether it was in quotes, which makes it a string.

    Returns:
        The value.
    """
    if quoted:
        return text
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    # strtol and strtod say ERANGE of what does not fit: the next type is tried then, a string in the end
    # (rcl_yaml_param_parser/src/parse.c).
    if _INTEGER.fullmatch(text) and len(text) <= _LONGEST_INTEGER and -(2**63) <= (value := _integer(text)) < 2**63:
        return value
    if text.lower() in _SPECIAL:
        return _SPECIAL[text.lower()]
    if _FLOAT.fullmatch(text) and math.isfinite(float(text)):
        return float(text)
    return text


def type_name(value: ParameterValue | None) -> str:
    """The name of a value's type as rclcpp prints it."""
    if isinstance(value, list):
        return f"{_scalar_name(value[0])}_array" if value else "not set"
    return "not set" if value is None else _scalar_name(value)


def _scalar_name(value: bool | int | float | str) -> str:
    if isinstance(value, bool):
        return "bool"
    if isinstance(value, int):
        return "integer"
    return "double" if isinstance(value, float) else "string"


Requirement = Callable[[str, ParameterValue], str]
"""Check of one value: takes the parameter's name and value, returns the complaint or an empty string."""


class ParameterError(ReasonError):
    """A parameter could not be declared or set.

    Args:
        reason: the message of the exception.
    """


@dataclass(frozen=True, slots=True)
class Parameter:
    """A declared parameter.

    Attributes:
        name: full name with dots.
        type: bool, integer, double, string, or string_array, double_array.
        default: value where none is given; None means that one must be given.
        requirements: checks of the value, in the order of upstream's declaration.
        read_only: whether it may change after the start.
    """

    name: str
    type: str
    default: ParameterValue | None
    requirements: tuple[Requirement, ...] = ()
    read_only: bool = False


def _check_type(parameter: Parameter, value: ParameterValue) -> None:
    if value == [] and parameter.type.endswith("_array"):
        # An empty list of a file has no type and arrives as "not set".
        raise ParameterError(f"parameter '{parameter.name}' has invalid type: No parameter value set")
    given = type_name(value)
    if given != parameter.type:
        raise ParameterError(
            f"parameter '{parameter.name}' has invalid type: Wrong parameter type, parameter {{{parameter.name}}} "
            f"is of type {{{parameter.type}}}, setting it to {{{given}}} is not allowed."
        )


def _complaint(parameter: Parameter, value: ParameterValue) -> str:
    for requirement in parameter.requirements:
        complaint = requirement(parameter.name, value)
        if complaint:
            return complaint
    return ""


class ParameterSet:
    """The declared parameters of one node.

    Args:
        given: values of the parameter files for this node.
    """

    def __init__(self, given: Mapping[str, ParameterValue]) -> None:
        self._given = dict(given)
        self._declared: dict[str, Parameter] = {}
        self._values: dict[str, ParameterValue] = {}

    def declare(self, parameters: Iterable[Parameter]) -> None:
        """Declare parameters: first the types of all, then the checks, as the generated code does.

        Raises:
            ParameterError: with the message that the node's init prints.
        """
        declared = [parameter for parameter in parameters if parameter.name not in self._declared]
        for parameter in declared:
            self._declare(parameter)
        for parameter in declared:
            complaint = _complaint(parameter, self._values[parameter.name])
            if complaint:
                raise ParameterError(
                    f"Invalid value set during initialization for parameter '{parameter.name}': {complaint}"
                )

    def _declare(self, parameter: Parameter) -> None:
        value = self._given.get(parameter.name)
        if value is not None:
            _check_type(parameter, value)
        elif parameter.default is None:
            raise ParameterError(f"parameter '{parameter.name}' is not initialized")
        else:
            value = parameter.default
        self._declared[parameter.name] = parameter
        self._values[parameter.name] = value

    def set(self, name: str, value: ParameterValue) -> None:
        """Change a parameter at run time.

        Raises:
            ParameterError: with the reason of the answer.
        """
        parameter = self._declared.get(name)
        if parameter is None:
            self._given[name] = value
            return
        if parameter.read_only:
            raise ParameterError(f"parameter '{name}' cannot be set because it is read-only")
        if type_name(value) != parameter.type:
            raise ParameterError(
                f"Wrong parameter type, parameter {{{name}}} is of type {{{parameter.type}}}, "
                f"setting it to {{{type_name(value)}}} is not allowed."
            )
        complaint = _complaint(parameter, value)
        if complaint:
            raise ParameterError(complaint)
        self._values[name] = value

    def text(self, name: str) -> str:
        """The value of a declared string."""
        return str(self._values[name])

    def number(self, name: str) -> float:
        """The value of a declared double or integer."""
        value = self._values[name]
        assert isinstance(value, int | float)
        return value

    def period_ns(self, name: str) -> int:
        """The period of a declared rate in Hz.

        Raises:
            LimitReachedError: the rate cannot be simulated.
        """
        rate_hz, most = self.number(name), limits().mock_rate
        if not _SLOWEST_HZ <= rate_hz <= most:
            text = f"parameter `{name}` is {rate_hz:g} Hz, from {_SLOWEST_HZ:g} to {most} Hz are simulated"
            raise LimitReachedError(text)
        return round(1e9 / rate_hz)

    def flag(self, name: str) -> bool:
        """The value of a declared boolean."""
        return self._values[name] is True

    def texts(self, name: str) -> tuple[str, ...]:
        """The value of a declared list of strings."""
        value = self._values[name]
        assert isinstance(value, list)
        return tuple(str(item) for item in value)

    def given(self, name: str) -> ParameterValue | None:
        """A value of the parameter file, declared or not."""
        return self._given.get(name)


def not_empty(name: str, value: ParameterValue) -> str:
    """The list or text must not be empty."""
    empty = isinstance(value, list | str) and len(value) == 0
    return f"Parameter '{name}' cannot be empty" if empty else ""


def unique(name: str, value: ParameterValue) -> str:
    """The list must not name anything twice."""
    if isinstance(value, list) and len(set(value)) != len(value):
        return f"Duplicate value(s) in parameter '{name}'"
    return ""


def longer_than_zero(name: str, value: ParameterValue) -> str:
    """The list must have an entry."""
    if isinstance(value, list) and not value:
        return f"Length of parameter '{name}' is '0' but must be greater than '0'"
    return ""


def subset_of(*allowed: str) -> Requirement:
    """Every entry must be one of the allowed ones."""

    def check(name: str, value: ParameterValue) -> str:
        for entry in value if isinstance(value, list) else []:
            if entry not in allowed:
                return f"Entry '{entry}' in parameter '{name}' is not in the set '{{{', '.join(allowed)}}}'"
        return ""

    return check


def one_of(*allowed: str) -> Requirement:
    """The text must be one of the allowed ones."""

    def check(name: str, value: ParameterValue) -> str:
        if value not in allowed:
            return f"Parameter '{name}' with the value '{value}' is not in the set '{{{', '.join(allowed)}}}'"
        return ""

    return check


def at_least(minimum: float) -> Requirement:
    """The number must not be smaller: declared as a floating point range of rclcpp."""

    def check(name: str, value: ParameterValue) -> str:
        if isinstance(value, int | float) and value < minimum:
            return f"Parameter {{{name}}} doesn't comply with floating point range."
        return ""

    return check
