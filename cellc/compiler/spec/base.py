"""What all spec models share: strict, frozen, no unknown keys; and the texts that serve as names.

A model is built when the first spec is parsed, with those inside it. Files of models do not import ``annotations`` from
``__future__``: pydantic would evaluate the text of every annotation again, which takes a twentieth of a check.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal, Union

from pydantic import AfterValidator, Discriminator, Field, StringConstraints, Tag, WithJsonSchema
from pydantic_core import PydanticCustomError

from cellc.contract.pins import DAY_PATTERN, day_of
from cellc.contract.stated import StatedModel, Text

PACKAGE_NAME_PATTERN = r"^[a-z][a-z0-9_]+$"
REFERENCE_PATTERN = r"^[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_.-]*)*$"

# Empty for the root namespace.
Namespace = Annotated[str, StringConstraints(pattern=r"^(/[A-Za-z_][A-Za-z0-9_]*)*$", max_length=128)]

# A node, controller or device by its name, or by its full name where several controllers share the short one.
NodeReference = Annotated[
    str, StringConstraints(pattern=r"^([A-Za-z][A-Za-z0-9_]*|(/[A-Za-z_][A-Za-z0-9_]*)+)$", max_length=256)
]

# REP-144: lower case, at least two characters, starts with a letter; the cell's name becomes a package name.
PackageName = Annotated[str, StringConstraints(pattern=PACKAGE_NAME_PATTERN, max_length=64)]

# A frame or link: `world`, `tcp`, or `device/link`; what follows the first slash is the name of the link.
FrameReference = Annotated[str, StringConstraints(pattern=REFERENCE_PATTERN, max_length=128)]

# `sensor_msgs/msg/Image`, `control_msgs/action/FollowJointTrajectory`: whether it exists is a rule's question.
InterfaceType = Annotated[str, StringConstraints(min_length=1, max_length=200)]


def shape_of(value: object) -> str | None:
    """Tell the branch of a union by the shape of its value, so that only that branch reports errors."""
    if isinstance(value, str):
        return "text"
    if isinstance(value, (list, tuple)):
        return "list"
    return "mapping" if isinstance(value, (dict, StatedModel)) else None


def _is_day(text: str) -> str:
    if day_of(text) is None:
        raise PydanticCustomError("wrong-type", "a date, such as `2026-07-01`")
    return text


Day = Annotated[
    str,
    AfterValidator(_is_day),
    WithJsonSchema({"type": "string", "pattern": f"^{DAY_PATTERN}$", "maxLength": 10}),
]
"""A day as YYYY-MM-DD (ISO 8601-1:2019)."""

StandardOr = Annotated[
    Union[Annotated[Literal["standard"], Tag("text")], Annotated[tuple[Text, ...], Tag("list")]],
    Discriminator(shape_of, custom_error_type="wrong-type", custom_error_message="`standard` or a list of names"),
]

# What every count fits into, whatever reads it: `size_t`, `int64` and doubles of JSON.
MOST = 2**31 - 1


def _parameter_shape(value: object) -> str | None:
    # bool before int: `True` is an int to Python.
    kinds: tuple[tuple[type, str], ...] = ((bool, "flag"), (int, "integer"), (float, "number"))
    if isinstance(value, (list, tuple)):
        item = _parameter_shape(value[0]) if value else "text"
        return f"{item}s" if item in ("flag", "integer", "number") else "texts"
    return next((kind for type_, kind in kinds if isinstance(value, type_)), shape_of(value))


def _without_nan(value: float) -> float:
    if math.isnan(value):
        raise PydanticCustomError("wrong-type", "a number other than `.nan`")
    return value


# Infinity is the default of every clamp of a PID; NaN compares with nothing, so that no limit would act on it.
_Number = Annotated[float, AfterValidator(_without_nan)]
_Integer = Annotated[int, Field(ge=-(2**63), le=2**63 - 1)]

# rcl_yaml_param_parser: ROS distinguishes `1` from `1.0`, so each scalar keeps the type that the user wrote; integers
# have 64 bits; the items of a list are of one type.
ParameterValue = Annotated[
    Union[
        Annotated[bool, Tag("flag")],
        Annotated[_Integer, Tag("integer")],
        Annotated[_Number, Tag("number")],
        Annotated[str, Tag("text")],
        Annotated[tuple[bool, ...], Tag("flags")],
        Annotated[tuple[_Integer, ...], Tag("integers")],
        Annotated[tuple[_Number, ...], Tag("numbers")],
        Annotated[tuple[str, ...], Tag("texts")],
    ],
    Discriminator(
        _parameter_shape,
        custom_error_type="wrong-type",
        custom_error_message="true, false, a number, text or a list of one of them",
    ),
]
