"""What all catalog models share: strict, frozen, no unknown keys; and their small types."""

from __future__ import annotations

import re
from typing import Annotated, Union

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, Strict, StringConstraints
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from cellc.vocabulary import (
    Behaviour,
    CommandAuthority,
    Distro,
    GateCode,
    ManagerLock,
    Moment,
    Motion,
    Need,
    Unmet,
)

# The patterns end with `\Z`: to Python's engine, `$` is before a last line break too.
Text = Annotated[str, StringConstraints(min_length=1, max_length=1000)]
Token = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_]*\Z", max_length=100)]
BareName = Annotated[str, StringConstraints(pattern=r"^\S+\Z", max_length=200)]
"""A name of an interface or a plugin: none has a space where it is declared."""
# What tf2 and MoveIt take for a link or a joint; some vendors number their links `link_3.0`.
PartName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_.-]*\Z", max_length=100)]
NodeName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_{}]+\Z", max_length=100)]
"""A name of the ROS graph of one token, with placeholders; it also becomes the name of a file."""
GraphName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_{}/~]+\Z", max_length=300)]
FileName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_][A-Za-z0-9_.-]*\Z", max_length=100)]
DAY = r"^\d{4}-\d{2}-\d{2}\Z"
Date = Annotated[str, StringConstraints(pattern=DAY)]
DistroName = Annotated[Distro, Strict(False)]
BehaviourName = Annotated[Behaviour, Strict(False)]
MomentName = Annotated[Moment, Strict(False)]
MotionName = Annotated[Motion, Strict(False)]
AuthorityName = Annotated[CommandAuthority, Strict(False)]
LockName = Annotated[ManagerLock, Strict(False)]
NeedName = Annotated[Need, Strict(False)]
UnmetName = Annotated[Unmet, Strict(False)]
GateName = Annotated[GateCode, Strict(False)]
ParameterFact = Union[bool, int, float, str, tuple[Union[bool, int, float, str], ...]]
"""A ROS parameter's value; an int where a double is declared is a mistake."""


class CatalogModel(BaseModel):
    """A part of the catalog: facts with their sources, in the units of the text."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid", regex_engine="python-re", defer_build=True)

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """Describe each property by what the docstring says of it, so that an editor shows it."""
        made = handler(schema)
        for name, one in handler.resolve_ref_schema(made).get("properties", {}).items():
            said = said_of(cls, name)
            if said:
                one["description"] = said
        return made


def said_of(model: type[BaseModel], name: str) -> str:
    """Return the sentences in which the docstring of a model names a key as ``key``."""
    sentences = re.split(r"(?<=\.) ", " ".join((model.__doc__ or "").split()))
    return " ".join(one for one in sentences if f"``{name}``" in one).replace("``", "`")
