"""Rows of the table of grades that fields declare themselves, and the values of such fields of a linked cell."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from types import UnionType
from typing import Annotated, Union, get_args, get_origin

from pydantic import BaseModel

from cellc.compiler.cell.entity import Entity, Part
from cellc.compiler.cell.members import annotations_of, members
from cellc.contract.base import ContractPose
from cellc.contract.grading import Graded
from cellc.contract.transforms import Pose
from cellc.tools.review.leaves import Leaf, Path, as_json, flatten
from cellc.tools.review.rules import Row


def rows_of(kind: type, pattern: str) -> Iterator[Row]:
    """Yield a row for each graded field of a model or an entity, those of the models inside it before its own.

    Args:
        pattern: path of a value of the kind.
    """
    for name, annotation in annotations_of(kind).items():
        grade, (inner, is_mapping) = _grade(annotation), _inner(annotation)
        below = f"{pattern} {name}" + (f" {{{grade.each}}}" if grade is not None and grade.each else "")
        if inner is not None and issubclass(inner, Part):
            yield from rows_of(inner, pattern)
        elif inner is not None and issubclass(inner, BaseModel) and (not is_mapping or below.endswith("}")):
            yield from rows_of(inner, below)
        if grade is not None:
            is_deep = inner is not None and (is_mapping or not grade.each)
            quantity = grade.quantity or re.sub("_(s|hz|m)$", "", name).replace("_", " ")
            yield Row(f"{below} ..." if is_deep else below, grade._replace(quantity=quantity))


def graded_values(entity: Entity, path: Path) -> Iterator[tuple[Path, Leaf]]:
    """Yield the graded fields of an entity of the cell that say something, by the names that people see."""
    for member in members(entity):
        if member.value and any(isinstance(mark, Graded) for mark in member.marks):
            yield from flatten(as_json(member.value), (*path, member.name))


def _grade(annotation: object) -> Graded | None:
    if get_origin(annotation) is not Annotated:
        return None
    return next((item for item in get_args(annotation) if isinstance(item, Graded)), None)


def _inner(annotation: object) -> tuple[type | None, bool]:
    """Return the model or entity of a value, or of the values of a mapping, and whether it is a mapping."""
    if get_origin(annotation) is Annotated:
        return _inner(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return next(
            (inner for option in get_args(annotation) if (inner := _inner(option))[0] is not None), (None, False)
        )
    if get_origin(annotation) in (dict, Mapping):
        return _inner(get_args(annotation)[1])[0], True
    if isinstance(annotation, type) and (issubclass(annotation, BaseModel) or is_dataclass(annotation)):
        return (None if annotation in (ContractPose, Pose) else annotation), False
    return None, False
