"""The one door through which contract.json, rehearsals.json and manifest.json of an untrusted folder come in."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import from_json

from cellc.contract.base import Json
from cellc.contract.errors import CellcError
from cellc.contract.limits import Limits, limits, option

_LARGEST_INTEGER = 2**63 - 1

_Model = TypeVar("_Model", bound=BaseModel)
_Path = tuple[str | int, ...]


class FormatError(CellcError):
    """A file is not what its name says, or larger than is read; the text says where and why, in one line."""


def read_json(text: str, model: type[_Model]) -> _Model:
    """Return the value of a file, every number of its kind and every list within the limits in force.

    Raises:
        FormatError: it is not.
    """
    most = limits()
    try:
        data: Json = from_json(text)
    except ValueError as error:
        raise FormatError(f"is not JSON: {error}") from None
    _check(data, most)
    try:
        return model.model_validate_json(text, strict=True, context=most)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        said = first["msg"]
        raise FormatError(f"{_shown(first['loc'])}{said[:1].lower()}{said[1:]}") from None


def _check(data: Json, most: Limits) -> None:
    """Refuse what no file of the compiler has, before anything is made of it."""
    number = 0
    open_: list[tuple[_Path, Json]] = [((), data)]
    while open_:
        path, value = open_.pop()
        number += 1
        if number > most.folder_values:
            raise FormatError(f"holds more than {most.folder_values} values")
        if isinstance(value, (dict, list)):
            if len(path) >= most.folder_depth:
                raise FormatError(f"{_shown(path)}is nested deeper than {most.folder_depth} levels")
            if len(value) > most.folder_entries:
                text = f"has {len(value)} entries, at most {most.folder_entries} are read; {option('folder-entries')}"
                raise FormatError(f"{_shown(path)}{text}")
            inner: Iterable[tuple[str | int, Json]] = value.items() if isinstance(value, dict) else enumerate(value)
            open_ += [((*path, step), each) for step, each in reversed(list(inner))]
        elif isinstance(value, float) and not math.isfinite(value):
            raise FormatError(f"{_shown(path)}must be a finite number, got {value:g}")
        elif isinstance(value, int) and abs(value) > _LARGEST_INTEGER:
            raise FormatError(f"{_shown(path)}must fit 64 bits, got a larger whole number")


def _shown(path: _Path) -> str:
    return f"`{'.'.join(map(str, path))}`: " if path else ""
