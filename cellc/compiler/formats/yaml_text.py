"""YAML text that a YAML 1.1 reader and rcl_yaml_param_parser take alike, and with the same types.

Mappings and lists of texts or mappings take one line an item, lists of numbers one line. An empty list has no type in a
parameter file, so that none is written.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Union

from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.formats.numbers import decimal
from cellc.contract.diagnostics.unsafe_text import HIDDEN

_Scalar = Union[bool, int, float, str]
Tree = Mapping[str, Union[ParameterValue, "Tree", tuple["Tree", ...]]]

_WIDTH = 120
_PLAIN = re.compile(r"[A-Za-z_/][A-Za-z0-9_./-]*")
# Texts that YAML 1.1 reads as a boolean or null, and strtod, which rcl_yaml_param_parser calls, as a number.
_MISREAD = frozenset(("y", "yes", "n", "no", "true", "false", "on", "off", "null", "nan", "inf", "infinity"))


def render(tree: Tree, depth: int = 0) -> str:
    """Write a mapping as block YAML, every level indented by two spaces; ends in a line break."""
    return "".join(f"{line}\n" for line in _mapping(tree, depth))


def render_rows(rows: Mapping[str, Mapping[str, ParameterValue]], depth: int = 0) -> str:
    """Write mappings of scalars and lists below their names, in flow style: one line, or a second with the lists."""
    indent = "  " * depth
    return "".join(
        f"{line}\n" for name, row in rows.items() for line in _row(f"{indent}{scalar(name)}: {{", row, indent)
    )


def _row(start: str, row: Mapping[str, ParameterValue], indent: str) -> Iterator[str]:
    entries = {key: f"{scalar(key)}: {_flow(value)}" for key, value in row.items()}
    line = f"{start}{', '.join(entries.values())}}}"
    if len(line) <= _WIDTH:
        yield line
        return
    lists = [key for key, value in row.items() if isinstance(value, tuple)] or [*row][-1:]
    yield f"{start}{', '.join(entries[key] for key in row if key not in lists)},"
    yield f"{indent}  {', '.join(entries[key] for key in lists)}}}"


def _flow(value: ParameterValue) -> str:
    return f"[{', '.join(map(scalar, value))}]" if isinstance(value, tuple) else scalar(value)


def scalar(value: _Scalar) -> str:
    """Write one value; a text is quoted where a reader would take it for something else."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return decimal(value)
    plain = _PLAIN.fullmatch(value) and value.lower() not in _MISREAD
    return value if plain else HIDDEN.sub(_as_escape, json.dumps(value, ensure_ascii=False))


def _as_escape(found: re.Match[str]) -> str:
    code = ord(found[0])
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def nested(parameters: Mapping[str, ParameterValue]) -> Tree:
    """Turn dotted parameter names into nested mappings.

    A name that is also the beginning of another (`a` and `a.b`) cannot be a mapping: what follows it stays dotted.
    """
    tree: dict[str, ParameterValue | Tree] = {}
    for name, value in parameters.items():
        level = tree
        *groups, leaf = _split(name, parameters)
        for group in groups:
            inner = level.setdefault(group, {})
            assert isinstance(inner, dict), "_split stops before a name that holds a value"
            level = inner
        level[leaf] = value
    return tree


def _split(name: str, names: Mapping[str, ParameterValue]) -> list[str]:
    parts = name.split(".")
    for count in range(1, len(parts)):
        if ".".join(parts[:count]) in names:
            return [*parts[: count - 1], ".".join(parts[count - 1 :])]
    return parts


def _mapping(tree: Tree, depth: int) -> Iterator[str]:
    indent = "  " * depth
    for key, value in tree.items():
        name = f"{indent}{scalar(key)}:"
        if isinstance(value, Mapping):
            # Without a value for its name: rcl refuses the file.
            if inner := tuple(_mapping(value, depth + 1)):
                yield name
                yield from inner
        elif isinstance(value, tuple):
            yield from _sequence(name, value, depth)
        else:
            yield f"{name} {scalar(value)}"


def _sequence(name: str, values: tuple[_Scalar | Tree, ...], depth: int) -> Iterator[str]:
    indent = "  " * depth
    trees = [value for value in values if isinstance(value, Mapping)]
    if trees:
        yield name
        for tree in trees:
            first, *others = _mapping(tree, depth + 2)
            yield f"{indent}  - {first.strip()}"
            yield from others
        return
    scalars = [value for value in values if not isinstance(value, Mapping)]
    yield from _scalars(name, scalars, indent)


def _scalars(name: str, values: list[_Scalar], indent: str) -> Iterator[str]:
    if values and all(isinstance(value, str) for value in values):
        yield name
        yield from (f"{indent}  - {scalar(value)}" for value in values)
    elif values:
        yield f"{name} {_flow(tuple(values))}"
