"""The fields of an entity with those of its parts, as people see them, and what their annotations add."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Annotated, ClassVar, get_args, get_origin, get_type_hints

from pydantic import BaseModel

from cellc.compiler.cell.entity import Part
from cellc.contract.frozen import dataclass
from cellc.contract.stated import StatedModel


@dataclass(frozen=True, slots=True)
class Member:
    """A field of an entity, or of one of its parts, with its value; ``marks`` is what its annotation adds."""

    name: str
    value: object
    marks: tuple[object, ...]


def members(of: object) -> Iterator[Member]:
    """Yield the fields of an entity, or of what it holds; those of a part are where the part is."""
    kind: type = type(of)
    for name, annotation in annotations_of(kind).items():
        value = getattr(of, name)
        if isinstance(value, Part):
            yield from members(value)
        else:
            yield Member(name, value, get_args(annotation)[1:] if get_origin(annotation) is Annotated else ())


@cache
def annotations_of(kind: type) -> Mapping[str, object]:
    """Return the annotations of the fields of a model or an entity, in their order, with what ``Annotated`` adds."""
    hints = get_type_hints(kind, include_extras=True)
    return {name: hint for name, hint in hints.items() if get_origin(hint) is not ClassVar}


def field_names(value: object) -> tuple[str, ...]:
    """Name the fields of an entity, or of a model that the spec and the cell share; none of any other value."""
    kind: type = type(value)
    return _field_names(kind)


@cache
def _field_names(kind: type) -> tuple[str, ...]:
    if issubclass(kind, StatedModel):
        return tuple(kind.model_fields)
    return tuple(field.name for field in fields(kind)) if is_dataclass(kind) else ()


def shared(of: object, model: type[BaseModel]) -> dict[str, object]:
    """Return the fields that an entity and a model of contract.json both have, with the values of the entity."""
    return {member.name: member.value for member in members(of) if member.name in model.model_fields}
