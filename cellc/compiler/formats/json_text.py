"""JSON text for review: what fits into a line is in one, everything else has one item a line.

The only item of a list, where it takes several lines, shares its brackets' lines: ``"sources": [{`` ... ``}]``.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from pydantic import BaseModel

from cellc.compiler.formats.numbers import positive_zero
from cellc.contract.diagnostics.unsafe_text import harmless_json

_WIDTH = 120

Json = None | bool | int | float | str | Sequence["Json"] | Mapping[str, "Json"]


def render(model: BaseModel) -> str:
    """Write a model in the order of its fields, without those at their default; ends in a line break."""
    return _value(model.model_dump(mode="json", exclude_defaults=True), "", 0) + "\n"


def _value(value: Json, key: str, depth: int) -> str:
    """Write a value behind its key, at the depth of the line that it begins on."""
    if isinstance(value, Mapping):
        entries = [_value(inner, f"{_scalar(name)}: ", depth + 1) for name, inner in value.items()]
        return key + _enclosed("{", entries, "}", len(key), depth)
    if isinstance(value, Sequence) and not isinstance(value, str):
        entries = [_value(inner, "", depth + 1) for inner in value]
        if key and len(value) == 1 and "\n" in entries[0]:
            return _value(value[0], f"{key}[", depth) + "]"
        return key + _enclosed("[", entries, "]", len(key), depth)
    return key + _scalar(value)


def _enclosed(start: str, entries: Sequence[str], end: str, before: int, depth: int) -> str:
    line = f"{start}{', '.join(entries)}{end}"
    fits = "\n" not in line and 2 * depth + before + len(line) < _WIDTH  # with the comma behind it
    if not entries or (fits and depth > 0):
        return line
    inner = "  " * (depth + 1)
    return f"{start}\n{inner}" + f",\n{inner}".join(entries) + f"\n{'  ' * depth}{end}"


def _scalar(value: Json) -> str:
    return harmless_json(json.dumps(positive_zero(value) if isinstance(value, float) else value, ensure_ascii=False))
