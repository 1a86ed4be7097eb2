"""Values of ROS parameters and their types, by the scalar rules of rcl_yaml_param_parser."""

from __future__ import annotations

import math
import re

ParameterValue = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]

_TRUE = ("Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON")
_FALSE = ("N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF")
_INTEGER = re.compile(r"[-+]?(0[xX][0-9a-fA-F]+|[0-9]+)")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
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
        quoted: whether it stood in quotes, which makes it a string.

    Returns:
        The value.
    """
    if quoted:
        return text
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if _INTEGER.fullmatch(text):
        return _integer(text)
    if text.lower() in _SPECIAL:
        return _SPECIAL[text.lower()]
    if _FLOAT.fullmatch(text):
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
