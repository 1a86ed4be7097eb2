"""The reference of the spec language as one Markdown page, made from the models: keys, what they take, examples."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import yaml

from cellc.spec import base
from cellc.spec.base import SpecModel
from cellc.spec.cell_spec import CellSpec
from cellc.spec.place import keys_in_order
from cellc.spec.schema import cell_schema

_INTRODUCTION = """\
<!-- Written by `cellc schema --reference` from the models of cellc/spec; do not edit. -->

# The spec language

A cell is one YAML 1.2 file. Every key is explained below with an example of its value. Keys that must be written
are bold. Each example is legal on its own; together they make no cell.

- **Quantities** carry their unit: `500 Hz`, `0 0 162 mm`, `50 %`. A bare number is an error. The tables name the units.
- **Names** begin with a letter and hold letters, digits and `_`.
- **Frames** are `world`, a frame of the cell, or a link of a device: `arm/tool0`.
- **UNKNOWN** is a value of every text: it blocks the real target and stands in the audit.
- **`include`** takes the path of a file, or a list of paths, whose sections are merged into this one.
"""
_WORDS = {
    base.NAME_PATTERN: "name",
    base.PACKAGE_NAME_PATTERN: "name in lower case",
    base.REFERENCE_PATTERN: "frame",
}
_SCALARS = {"integer": "whole number", "number": "number", "boolean": "`true` or `false`", "string": "text"}
_MANY = 4
"""More kinds of one thing than these stand in a table, not in a section each."""

_Schema = Mapping[str, Any]
_Wrap = Callable[[Any], Any]


@dataclass(frozen=True, slots=True)
class _Section:
    """A mapping of the spec, where it first occurs; ``wrap`` puts its content at that place."""

    model: str
    path: str
    wrap: _Wrap


def spec_reference() -> str:
    """Return the page."""
    page = _Page(cell_schema())
    return re.sub(r"\n{3,}", "\n\n", "\n".join([_INTRODUCTION, *page.lines(), ""]))


class _Page:
    """Walks the schema from the cell inwards, and describes every model once."""

    def __init__(self, schema: _Schema) -> None:
        self._schema = schema
        self._models = {model.__name__: model for model in _subclasses(SpecModel)}
        self._seen: set[str] = set()

    def lines(self) -> Iterator[str]:
        root = self._schema["properties"]
        yield "| key | what it is |\n|---|---|"
        yield from (f"| {self._key('CellSpec', key)} | {root[key]['description']} |" for key in _keys(CellSpec))
        for key in _keys(CellSpec):
            if not self._children(root[key]):
                continue
            yield f"\n## {key}\n\n{root[key]['description']}\n"
            for section in self._below("CellSpec", key, "", lambda content: content):
                yield from self._described(section)

    def _described(self, section: _Section) -> Iterator[str]:
        """Yield the section of a model, then those of the models that occur in it."""
        if section.model in self._seen:
            return
        self._seen.add(section.model)
        schema = self._schema["$defs"][section.model]
        keys = keys_in_order(self._models[section.model])
        example = {key: self._example(section.model, key) for key in keys}
        if _title(section.model).lower() != section.path:  # the heading of the key has the same words
            yield f"\n### {_title(section.model)}\n"
        yield f"`{section.path}`: {schema['description']}\n"
        yield f"```yaml\n{_yaml(section.wrap(example))}```\n"
        yield "| key | value | meaning |\n|---|---|---|"
        yield from (self._row(section.model, key, schema["properties"][key]) for key in keys)
        for key in keys:
            inner = list(self._below(section.model, key, f"{section.path}.", section.wrap))
            if len(inner) > _MANY:
                yield from self._kinds(key, list({kind.model: kind for kind in inner}.values()))
            else:
                yield from (line for kind in inner for line in self._described(kind))

    def _kinds(self, key: str, kinds: list[_Section]) -> Iterator[str]:
        """Yield a table of the kinds that a key takes, then the sections of the models that occur in them."""
        yield f"\n#### Kinds of `{key}`\n\n| example | meaning | further keys |\n|---|---|---|"
        for kind in kinds:
            schema = self._schema["$defs"][kind.model]
            keys = keys_in_order(self._models[kind.model])
            required = [name for name in keys if name in schema.get("required", ())]
            optional = ", ".join(f"`{name}`" for name in keys if name not in required)
            example = _flow({name: self._example(kind.model, name) for name in required})
            yield f"| `{example}` | {schema['description']} | {optional} |"
        for kind in kinds:
            for name in keys_in_order(self._models[kind.model]):
                for inner in self._below(kind.model, name, f"{kind.path}.", kind.wrap):
                    yield from self._described(inner)

    def _below(self, model: str, key: str, path: str, wrap: _Wrap) -> Iterator[_Section]:
        """Yield the models that a key takes; the keys that its own mapping must have stand beside it."""
        schema = self._schema if model == "CellSpec" else self._schema["$defs"][model]
        required = [] if model == "CellSpec" else schema.get("required", [])
        beside = {name: self._example(model, name) for name in required if name != key}
        for name, container in self._children(schema["properties"][key]):
            at = f"{path}{key}{'.NAME' if container == 'mapping' else ''}"
            yield _Section(name, at, _around(wrap, beside, key, _container(container, self._example(model, key))))

    def _row(self, model: str, key: str, field: _Schema) -> str:
        meaning = field["description"]
        if field.get("default") not in (None, "", [], {}):
            meaning += f" Absent: `{_scalar(field['default'])}`."
        return f"| {self._key(model, key)} | {self._takes(field)} | {meaning} |"

    def _key(self, model: str, key: str) -> str:
        schema = self._schema if model == "CellSpec" else self._schema["$defs"][model]
        code = f"[`{key}`](#{key})" if model == "CellSpec" and self._children(schema["properties"][key]) else f"`{key}`"
        return f"**{code}**" if key in schema.get("required", []) else code

    def _takes(self, field: _Schema) -> str:
        """Say in words what a value may be."""
        if "$ref" in field:
            return self._linked(field["$ref"].rpartition("/")[2])
        if "x-units" in field:
            return _numbers(field["pattern"])
        if "const" in field or "enum" in field:
            return ", ".join(f"`{_scalar(value)}`" for value in field.get("enum", [field.get("const")]))
        for several in ("oneOf", "anyOf"):
            if several in field:
                words = dict.fromkeys(self._takes(option) for option in field[several])
                return "one of the kinds below" if len(words) > _MANY else " or ".join(words)
        if field.get("type") == "array":
            return f"list of {self._takes(field['items'])}"
        if field.get("type") == "object":
            inner = field.get("additionalProperties")
            return f"mapping of names to {self._takes(inner)}" if isinstance(inner, dict) else "mapping"
        return _WORDS.get(field.get("pattern", ""), _SCALARS[field["type"]])

    def _linked(self, model: str) -> str:
        schema = self._schema["$defs"][model]
        if "enum" in schema:
            return ", ".join(f"`{value}`" for value in schema["enum"])
        title = _title(model)
        return f"[{title.lower()}](#{title.lower().replace(' ', '-')})"

    def _children(self, field: _Schema, container: str = "") -> list[tuple[str, str]]:
        """List the models that a field takes, each with what it stands in: a mapping, a list or nothing."""
        if "$ref" in field:
            name = field["$ref"].rpartition("/")[2]
            return [(name, container)] if name in self._models else []
        inner = [(option, container) for several in ("oneOf", "anyOf") for option in field.get(several, ())]
        if isinstance(field.get("additionalProperties"), dict):
            inner.append((field["additionalProperties"], "mapping"))
        if "items" in field:
            inner.append((field["items"], "list"))
        return [child for option, where in inner for child in self._children(option, where)]

    def _example(self, model: str, key: str) -> Any:
        fields = self._models[model].model_fields
        (examples,) = (field.examples for name, field in fields.items() if (field.alias or name) == key)
        assert examples, f"{model}.{key} has no example"
        return examples[0]


def _subclasses(model: type[SpecModel]) -> Iterator[type[SpecModel]]:
    for subclass in model.__subclasses__():
        yield subclass
        yield from _subclasses(subclass)


def _keys(model: type[SpecModel]) -> list[str]:
    return [field.alias or name for name, field in model.model_fields.items()]


def _container(container: str, example: Any) -> _Wrap:
    if container == "mapping":
        name = next(iter(example)) if isinstance(example, dict) else "task"
        return lambda content: {name: content}
    return (lambda content: [content]) if container == "list" else (lambda content: content)


def _around(wrap: _Wrap, beside: Mapping[str, Any], key: str, inside: _Wrap) -> _Wrap:
    return lambda content: wrap({**beside, key: inside(content)})


def _title(model: str) -> str:
    words = re.sub(r"(?<!^)(?=[A-Z])", " ", model.removesuffix("Spec")).capitalize()
    return {"Qos": "QoS", "Nic": "Network card"}.get(words, words)


def _numbers(pattern: str) -> str:
    count = re.search(r"\)\{(\d+)\}\[", pattern)
    if count is None:
        return "numbers and a unit"
    return "number and unit" if count[1] == "0" else f"{int(count[1]) + 1} numbers and a unit"


def _scalar(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _flow(data: Any) -> str:
    return yaml.safe_dump(data, default_flow_style=True, sort_keys=False, width=1000).strip()


def _yaml(data: Any) -> str:
    return yaml.safe_dump(data, default_flow_style=None, sort_keys=False, width=1000, allow_unicode=True)
