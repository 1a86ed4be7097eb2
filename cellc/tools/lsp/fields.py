"""What the models of the spec say of a path: description, example, units, words, keys."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from types import UnionType
from typing import Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic_core import PydanticCustomError

from cellc.compiler.catalog.catalog_model import said_of, summary_of
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.read_model import is_device
from cellc.compiler.source.document import Plain
from cellc.compiler.spec.base import REFERENCE_PATTERN
from cellc.compiler.spec.place import (
    bare,
    branches,
    chosen,
    fields_by_key,
    inner,
    is_tagged,
    keys_in_order,
    model_of,
    required,
)
from cellc.compiler.spec.plant import spec_model
from cellc.compiler.spec.quantity import Quantity, QuantityType, QuantityVector
from cellc.compiler.spec.wording import value_at
from cellc.contract.diagnostics import YamlPath


@dataclass(frozen=True, slots=True)
class Key:
    """A key that a mapping may have, and what it means."""

    name: str
    meaning: str
    required: bool
    example: str


def root_model(data: Plain) -> type[BaseModel]:
    """Return the model that reads a file: that of a device where its first keys say so."""
    return DeviceModel if is_device(data) else spec_model(data)


def annotation_at(data: Plain, path: YamlPath) -> object:
    """Return the annotation of what is at a path; ``object`` where no model knows it."""
    annotation: object = root_model(data)
    for number, part in enumerate(path):
        annotation = inner(chosen(annotation, value_at(data, path[:number])), part)
    return annotation


def keys_at(data: Plain, path: YamlPath) -> list[Key]:
    """Return the keys that the mapping at a path may still have, in their order."""
    present = value_at(data, path)
    present_keys = set(present) if isinstance(present, dict) else set()
    keys: dict[str, Key] = {}
    for model in _models(annotation_at(data, path), present):
        for name in keys_in_order(model):
            if name not in present_keys:
                keys.setdefault(name, _key(model, name))
    return list(keys.values())


def meaning_of(data: Plain, path: YamlPath) -> str:
    """Return what the key at the end of a path means, with its units; empty where nothing is said of it."""
    if not path:
        return ""
    holder = chosen(annotation_at(data, path[:-1]), value_at(data, path[:-1]))
    model = model_of(holder)
    if model is not None and str(path[-1]) in fields_by_key(model):
        meaning = _key(model, str(path[-1])).meaning
        if meaning:
            return meaning
    inner = model_of(chosen(annotation_at(data, path), value_at(data, path)))
    return summary_of(inner) if inner is not None else ""


def words_of(annotation: object) -> list[str]:
    """Return the words that a value may be: those of a closed list, true and false."""
    annotation = bare(annotation)
    if get_origin(annotation) is Literal:
        return [
            str(argument).lower() if isinstance(argument, bool) else str(argument) for argument in get_args(annotation)
        ]
    if annotation is bool:
        return ["true", "false"]
    if isinstance(annotation, type) and issubclass(annotation, Enum):
        return [str(enum.value) for enum in annotation]
    if is_tagged(annotation):
        return [word for branch in branches(annotation).values() for word in words_of(branch)]
    return [word for option in _options(annotation) for word in words_of(option)]


def takes_a_frame(annotation: object) -> bool:
    """Whether a value names a frame."""
    return any(
        getattr(argument, "pattern", None) == REFERENCE_PATTERN for argument in get_args(required(annotation))[1:]
    )


def quantity_of(annotation: object, text: str) -> tuple[QuantityType, Quantity | QuantityVector] | None:
    """Return how a value with a unit is read, with the value; None for anything else."""
    for kind in _quantity_types(annotation):
        with suppress(PydanticCustomError):
            return kind, kind.read(text)
    return None


def _quantity_types(annotation: object) -> Iterator[QuantityType]:
    annotation = required(annotation)
    yield from (item for item in get_args(annotation)[1:] if isinstance(item, QuantityType))
    inner_ones = branches(annotation).values() if is_tagged(annotation) else _options(bare(annotation))
    for option in inner_ones:
        yield from _quantity_types(option)


def _key(model: type[BaseModel], name: str) -> Key:
    field = fields_by_key(model)[name]
    quantity = next(_quantity_types(inner(model, name)), None)
    units = f" Units: {', '.join(quantity.units())}." if quantity is not None else ""
    example = re.sub(r"'", "", str(field.examples[0])) if field.examples else ""
    meaning = field.description or _documented(model, name)
    return Key(name, f"{meaning}{units}".strip(), field.is_required(), example)


def _documented(model: type[BaseModel], name: str) -> str:
    """Return what the docstring of a model says of a key, and that of the model which reads its value."""
    value = next(_models(inner(model, name), None), None) or next(_models(inner(inner(model, name), 0), None), None)
    kind = summary_of(value) if value is not None else ""
    return f"{said_of(model, name)} {kind}".strip()


def _models(annotation: object, data: Plain) -> Iterator[type[BaseModel]]:
    """Yield the model of a mapping, or all of them where nothing tells which is meant yet."""
    model = model_of(chosen(annotation, data))
    if model is not None:
        yield model
        return
    annotation = required(annotation)
    several = bare(annotation)
    for option in branches(annotation).values() if is_tagged(annotation) else _options(several):
        yield from _models(option, data)


def _options(annotation: object) -> tuple[object, ...]:
    return get_args(annotation) if get_origin(annotation) in (Union, UnionType) else ()
