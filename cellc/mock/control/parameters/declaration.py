"""Declared parameters: types, defaults and checks, with the messages of generate_parameter_library and rclcpp."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from cellc.mock.control.parameters.values import ParameterValue, type_name

Requirement = Callable[[str, ParameterValue], str]
"""Check of one value: takes the parameter's name and value, returns the complaint or an empty string."""


class ParameterError(Exception):
    """A parameter could not be declared or set.

    Args:
        reason: the message of the exception.
    """

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


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
