"""JSON text for review: what fits into a line is in one, everything else has one item a line.

Texts and figures of a longer list fill its lines, and so do those of an entry of a table: a list, or a mapping of
mappings. The only item of a list, where it takes several lines, shares its brackets' lines: ``"sources": [{`` ...
``}]``.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence

from pydantic import BaseModel

from cellc.compiler.formats.numbers import positive_zero
from cellc.contract.diagnostics.unsafe_text import harmless_json

_WIDTH = 120
_PLAIN = json.JSONEncoder(ensure_ascii=False)

Json = None | bool | int | float | str | Sequence["Json"] | Mapping[str, "Json"]


def render(model: BaseModel) -> str:
    """Write a model in the order of its fields, without those at their default; ends in a line break."""
    return _value(model.model_dump(mode="json", exclude_defaults=True), "", 0) + "\n"


def _value(value: Json, key: str, depth: int, *, row: bool = False) -> str:
    """Write a value behind its key, at the depth of the line that it begins on; ``row`` is an entry of a table."""
    if isinstance(value, Mapping):
        table = all(isinstance(inner, Mapping) for inner in value.values())
        entries = [_value(inner, f"{_scalar(name)}: ", depth + 1, row=table) for name, inner in value.items()]
        return key + _enclosed("{", _filled(value.values(), entries, depth) if row else entries, "}", len(key), depth)
    if isinstance(value, Sequence) and not isinstance(value, str):
        entries = [_value(inner, "", depth + 1, row=True) for inner in value]
        if key and len(value) == 1 and "\n" in entries[0]:
            return _value(value[0], f"{key}[", depth, row=True) + "]"
        return key + _enclosed("[", _filled(value, entries, depth), "]", len(key), depth)
    return key + _scalar(value)


def _filled(values: Iterable[Json], entries: Sequence[str], depth: int) -> list[str]:
    """Return lines that hold as many texts and figures in a row as fit, each with the comma that ends it."""
    lines, open_ = list[str](), False
    for value, entry in zip(values, entries, strict=True):
        plain = value is None or isinstance(value, (bool, int, float, str))
        if plain and open_ and 2 * (depth + 1) + len(lines[-1]) + len(entry) + 3 <= _WIDTH:
            lines[-1] += f", {entry}"
        else:
            lines.append(entry)
        open_ = plain
    return lines


def _enclosed(start: str, entries: Sequence[str], end: str, before: int, depth: int) -> str:
    line = f"{start}{', '.join(entries)}{end}"
    fits = "\n" not in line and 2 * depth + before + len(line) < _WIDTH  # with the comma behind it
    if not entries or (fits and depth > 0):
        return line
    inner = "  " * (depth + 1)
    return f"{start}\n{inner}" + f",\n{inner}".join(entries) + f"\n{'  ' * depth}{end}"


def _scalar(value: Json) -> str:
    return harmless_json(_PLAIN.encode(positive_zero(value) if isinstance(value, float) else value))
