"""What all catalog models share: strict, frozen, no unknown keys; and their small types."""

from __future__ import annotations

import inspect
import re
from typing import Annotated, Union

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, Strict, StringConstraints
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from cellc.contract.attempt import Layer
from cellc.contract.vocabulary import (
    Behavior,
    CommandAuthority,
    Distro,
    GateCode,
    LeftBy,
    ManagerLock,
    Moment,
    Motion,
    Need,
    Unmet,
)

# The patterns end with `\Z`: to Python's engine, `$` is before a last line break too.
Text = Annotated[str, StringConstraints(min_length=1, max_length=1000)]
Token = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_]*\Z", max_length=100)]
_PART = "[A-Za-z0-9_][A-Za-z0-9_.+ -]*"
INNER = rf"^{_PART}(/{_PART})*\Z"
InnerPath = Annotated[str, StringConstraints(pattern=INNER, max_length=1000)]
"""A file from a folder down, with forward slashes; it leads nowhere else."""
BareName = Annotated[str, StringConstraints(pattern=r"^\S+\Z", max_length=200)]
"""A name of an interface or a plugin: none has a space where it is declared."""
# What tf2 and MoveIt take for a link or a joint: some vendors number their links `link_3.0`, or write `robot/link`.
PartName = Annotated[
    str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_.-]*(/[A-Za-z_][A-Za-z0-9_.-]*)*\Z", max_length=100)
]
NodeName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_{}]+\Z", max_length=100)]
"""A name of the ROS graph of one token, with placeholders; it also becomes the name of a file."""
GraphName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_{}/~]+\Z", max_length=300)]
FileName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_][A-Za-z0-9_.-]*\Z", max_length=100)]
_HOST = "[A-Za-z0-9]([A-Za-z0-9.-]*[A-Za-z0-9])?"
_PORT = "(:[0-9]{1,5})?"
_STEPS = "[A-Za-z0-9_][A-Za-z0-9_.+~-]*(/[A-Za-z0-9_][A-Za-z0-9_.+~-]*)*/?"
URL = rf"^(https://{_HOST}{_PORT}/|ssh://([a-z_][a-z0-9_-]*@)?{_HOST}{_PORT}/|git@{_HOST}:){_STEPS}\Z"
RepositoryUrl = Annotated[str, StringConstraints(pattern=URL, max_length=300)]
"""Where git fetches from, over HTTPS or SSH: no option, no file, and no transport that runs a program."""
DAY = r"^\d{4}-\d{2}-\d{2}\Z"
Date = Annotated[str, StringConstraints(pattern=DAY)]
DistroName = Annotated[Distro, Strict(False)]
BehaviorName = Annotated[Behavior, Strict(False)]
MomentName = Annotated[Moment, Strict(False)]
MotionName = Annotated[Motion, Strict(False)]
AuthorityName = Annotated[CommandAuthority, Strict(False)]
LeftByName = Annotated[LeftBy, Strict(False)]
LockName = Annotated[ManagerLock, Strict(False)]
NeedName = Annotated[Need, Strict(False)]
UnmetName = Annotated[Unmet, Strict(False)]
GateName = Annotated[GateCode, Strict(False)]
LayerName = Annotated[Layer, Strict(False)]
ParameterFact = Union[bool, int, float, str, tuple[Union[bool, int, float, str], ...]]
"""A ROS parameter's value; an int where a double is declared is a mistake."""


_ATTRIBUTES = "Attributes:\n"


class CatalogModel(BaseModel):
    """A part of the catalog: facts with their sources, in the units of the text."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid", regex_engine="python-re", defer_build=True)

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """Describe the model and each property by what its docstring says, so that an editor shows it."""
        schema_of = handler(schema)
        whole = handler.resolve_ref_schema(schema_of)
        whole["description"] = summary_of(cls)
        for name, property_schema in whole.get("properties", {}).items():
            if said := said_of(cls, name):
                property_schema["description"] = said + _unit_note(property_schema)
        return schema_of


def summary_of(model: type[BaseModel]) -> str:
    """Return what the docstring of a model says about it as a whole."""
    return " ".join((model.__doc__ or "").partition(_ATTRIBUTES)[0].split()).replace("``", "`")


def said_of(model: type[BaseModel], name: str) -> str:
    """Return what the docstring of a model, or of one that it extends, says of a key under ``Attributes``."""
    for kind in model.__mro__:
        attribute = re.search(rf"^ +{re.escape(name)}: (.*(?:\n {{8}}.*)*)", _attributes(kind), re.MULTILINE)
        if attribute is not None:
            return " ".join(attribute[1].split()).replace("``", "`")
    return ""


def _attributes(model: type) -> str:
    return inspect.cleandoc(model.__doc__ or "").partition(_ATTRIBUTES)[2]


def _unit_note(field: JsonSchemaValue) -> str:
    """Return the units of a field whose values, or the values of whose keys, are quantities."""
    if "x-units" in field:
        return f" Units: {', '.join(map(str, field['x-units']))}."
    inner = (*field.get("anyOf", ()), field.get("items"), *field.get("patternProperties", {}).values())
    values = (*inner, field.get("additionalProperties"))
    return next((unit for value in values if isinstance(value, dict) and (unit := _unit_note(value))), "")
