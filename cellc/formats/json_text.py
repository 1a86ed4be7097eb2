"""JSON text for review: one item a line, except short lists of plain values, which stay on theirs."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from pydantic import BaseModel

from cellc.formats.numbers import positive_zero

_WIDTH = 120

Json = None | bool | int | float | str | Sequence["Json"] | Mapping[str, "Json"]


def render(model: BaseModel) -> str:
    """Write a model in the order of its fields; ends in a line break."""
    return _value(model.model_dump(mode="json"), 0) + "\n"


def _value(value: Json, depth: int) -> str:
    if isinstance(value, Mapping):
        entries = [f"{_scalar(key)}: {_value(inner, depth + 1)}" for key, inner in value.items()]
        return _block("{", entries, "}", depth)
    if isinstance(value, Sequence) and not isinstance(value, str):
        entries = [_value(inner, depth + 1) for inner in value]
        line = f"[{', '.join(entries)}]"
        plain = not any(isinstance(inner, (Mapping, list)) for inner in value)
        return line if plain and len(line) + 2 * depth <= _WIDTH else _block("[", entries, "]", depth)
    return _scalar(value)


def _block(start: str, entries: Sequence[str], end: str, depth: int) -> str:
    if not entries:
        return start + end
    inner = "  " * (depth + 1)
    return f"{start}\n{inner}" + f",\n{inner}".join(entries) + f"\n{'  ' * depth}{end}"


def _scalar(value: Json) -> str:
    return json.dumps(positive_zero(value) if isinstance(value, float) else value, ensure_ascii=False)
