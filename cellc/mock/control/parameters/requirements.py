"""Checks of parameter values, worded as the validators of generate_parameter_library."""

from __future__ import annotations

from cellc.mock.control.parameters.declaration import Requirement
from cellc.mock.control.parameters.values import ParameterValue


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
