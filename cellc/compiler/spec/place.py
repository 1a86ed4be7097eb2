"""Follow an error's location through the models to the YAML path that the user wrote."""

from __future__ import annotations

import types
from functools import cache
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel, Discriminator, Tag
from pydantic.fields import FieldInfo

from cellc.compiler.spec.kinds import Kinds
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass

_KEY_MARK = "[key]"  # how pydantic ends the location of an error in a key


@dataclass(frozen=True, slots=True)
class Place:
    """Where an error is, and what the models expect there.

    Args:
        path: keys and indices of the document, without the branches of unions.
        is_key: the key at the end of ``path`` is wrong, not its value.
        expected: annotation of the value at ``path``.
        models: the models on the way with their paths, outermost first; the last one holds the end of ``path``.
        field: the field that ``path`` ends in, or None in a list, a mapping of names, or at an unknown key.
    """

    path: YamlPath
    is_key: bool
    expected: object
    models: tuple[tuple[YamlPath, type[BaseModel]], ...]
    field: FieldInfo | None


def place_of(location: tuple[str | int, ...], root: type[BaseModel]) -> Place:
    """Return the place of an error in a document whose root is read by ``root``."""
    is_key = len(location) > 1 and location[-1] == _KEY_MARK
    path: YamlPath = ()
    expected: object = root
    models: tuple[tuple[YamlPath, type[BaseModel]], ...] = ()
    field: FieldInfo | None = None
    for part in location[:-1] if is_key else location:
        expected = required(expected)
        if is_tagged(expected):
            expected = branch(expected, str(part))
            continue
        model = model_of(expected)
        field = fields_by_key(model).get(str(part)) if model else None
        models = (*models, (path, model)) if model else models
        expected = inner(expected, part)
        path = (*path, part)
    return Place(path, is_key, required(expected), models, field)


def required(annotation: object) -> object:
    """Remove ``None`` from an optional annotation."""
    if get_origin(annotation) in (Union, types.UnionType):
        present = [arg for arg in get_args(annotation) if arg is not type(None)]
        return present[0] if len(present) == 1 else annotation
    return annotation


def is_tagged(annotation: object) -> bool:
    """Whether the annotation is a union whose branch is reported by a discriminator."""
    return get_origin(annotation) is Annotated and any(
        isinstance(each, (Discriminator, Kinds)) for each in get_args(annotation)[1:]
    )


def branches(annotation: object) -> dict[str, object]:
    """Return the branches of a tagged union by tag, in the order of the union."""
    kinds = _kinds(annotation)
    if kinds is not None:
        return {str(key): kinds.model(key) for key in kinds.keys}
    options = get_args(get_args(annotation)[0])
    return {entry.tag: option for option in options for entry in get_args(option)[1:] if isinstance(entry, Tag)}


def branch(annotation: object, tag: str) -> object:
    """Return one branch of a tagged union; ``object`` for a tag that it does not have."""
    return branches(annotation).get(tag, object)


def chosen(annotation: object, data: object) -> object:
    """Return the annotation that reads ``data``: of a tagged union the branch, of an optional one what is there."""
    annotation = required(annotation)
    while is_tagged(annotation):
        annotation = required(_chosen(annotation, data))
    return annotation


def _chosen(annotation: object, data: object) -> object:
    """Return the branch of a tagged union that reads ``data``."""
    kinds = _kinds(annotation)
    if kinds is not None:
        key = kinds.key_of(data)
        return object if key is None else kinds.model(key)
    tag = next(each for each in get_args(annotation)[1:] if isinstance(each, Discriminator)).discriminator
    return branch(annotation, str(tag(data)) if callable(tag) else "")


def _kinds(annotation: object) -> Kinds[str] | None:
    return next((each for each in get_args(annotation)[1:] if isinstance(each, Kinds)), None)


def bare(annotation: object) -> object:
    """Remove ``None`` and all metadata."""
    annotation = required(annotation)
    return required(get_args(annotation)[0]) if get_origin(annotation) is Annotated else annotation


def model_of(annotation: object) -> type[BaseModel] | None:
    """Return the annotation if it is a model."""
    annotation = bare(annotation)
    return annotation if isinstance(annotation, type) and issubclass(annotation, BaseModel) else None


def mapping_values(annotation: object) -> object | None:
    """Return the annotation of the values if the annotation is a mapping of names."""
    annotation = bare(annotation)
    return get_args(annotation)[1] if get_origin(annotation) is dict else None


@cache
def annotations_by_key(model: type[BaseModel]) -> dict[str, object]:
    """Return the annotations of a model, metadata included, by the key that the user writes."""
    hints: dict[str, Any] = get_type_hints(model, include_extras=True)
    return {info.alias or name: hints[name] for name, info in model.model_fields.items()}


@cache
def fields_by_key(model: type[BaseModel]) -> dict[str, FieldInfo]:
    """Return the fields of a model by the key that the user writes."""
    return {info.alias or name: info for name, info in model.model_fields.items()}


@cache
def keys_in_order(model: type[BaseModel]) -> tuple[str, ...]:
    """Return the keys of a model in the order in which the reference gives them and ``cellc format`` writes them.

    That is the order of its fields; those that it shares with its kin stand behind the own field that it names.
    """
    keys = tuple(fields_by_key(model))
    after = getattr(model, "SHARED_AFTER", "")
    if not after:
        return keys
    shared = tuple(key for key in keys if any(key in fields_by_key(base) for base in _kin(model)))
    remaining = tuple(key for key in keys if key not in shared)
    at = remaining.index(after) + 1 if after in remaining else len(remaining)
    return (*remaining[:at], *shared, *remaining[at:])


def _kin(model: type[BaseModel]) -> tuple[type[BaseModel], ...]:
    return tuple(base for base in model.__bases__ if issubclass(base, BaseModel))


def inner(annotation: object, part: str | int) -> object:
    """Return the annotation of what is at a key or an index of a value; ``object`` without one."""
    model = model_of(annotation)
    if model is not None:
        return annotations_by_key(model).get(str(part), object)
    values = mapping_values(annotation)
    if values is not None:
        return values
    plain = bare(annotation)
    return get_args(plain)[0] if get_origin(plain) is tuple else object
