"""The reference of a file as one Markdown page, made from its models: keys, what they take, and examples."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, get_args

import yaml
from pydantic import BaseModel

from cellc.compiler.spec import base
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.place import branches, is_tagged, keys_in_order
from cellc.compiler.spec.schema import cell_schema
from cellc.contract.frozen import dataclass
from cellc.contract.stated import NAME_PATTERN

_INTRODUCTION = """\
<!-- Written by `cellc schema --reference` from the models of cellc/spec; do not edit. -->

# The spec language

A cell is one YAML 1.2 file. Every key is explained below with an example of its value. Keys that must be written
are bold. Each example is legal on its own; together they make no cell.

- **Quantities** carry their unit: `500 Hz`, `0 0 162 mm`, `50 %`. A bare number is an error. The tables name the units.
- **Names** begin with a letter and hold letters, digits and `_`.
- **Frames** are `world`, a frame of the cell, or a link of a device: `arm/tool0`.
- **UNKNOWN** is a value of every text: it blocks the real target and is listed in the audit.
- **`include`** takes the path of a file, or a list of paths, whose sections are merged into this one.
"""
_WORDS = {
    NAME_PATTERN: "name",
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
    return reference_page(_INTRODUCTION, cell_schema(), CellSpec)


def reference_page(introduction: str, schema: _Schema, root: type[BaseModel]) -> str:
    """Return the page of a schema and of the model that it was made from."""
    page = _Page(schema, root)
    return re.sub(r"\n{3,}", "\n\n", "\n".join([introduction, *page.lines(), ""]))


class _Page:
    """Walks the schema from its root inwards, and describes every model once."""

    def __init__(self, schema: _Schema, root: type[BaseModel]) -> None:
        self._schema = schema
        self._root = root
        self._models = {model.__name__: model for model in _models(root)}
        self._seen: set[str] = set()

    def lines(self) -> Iterator[str]:
        root, top = self._schema["properties"], self._root.__name__
        yield "| key | what it is |\n|---|---|"
        yield from (f"| {self._key(top, key)} | {root[key]['description']} |" for key in _keys(self._root))
        for key in _keys(self._root):
            if not self._children(root[key]):
                continue
            yield f"\n## {key}\n\n{root[key]['description']}\n"
            for section in self._below(top, key, "", lambda content: content):
                yield from self._described(section)

    def _described(self, section: _Section) -> Iterator[str]:
        """Yield the section of a model, then those of the models that occur in it."""
        if section.model in self._seen:
            return
        self._seen.add(section.model)
        schema = self._schema["$defs"][section.model]
        keys = keys_in_order(self._models[section.model])
        example = {key: shown for key in keys if (shown := self._example(section.model, key)) is not None}
        if _title(section.model).lower() != section.path:  # the heading of the key has the same words
            yield f"\n### {_title(section.model)}\n"
        yield f"`{section.path}`: {schema['description']}\n"
        if example:
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
        schema = self._of(model)
        required = [] if schema is self._schema else schema.get("required", [])
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
        schema = self._of(model)
        leads = schema is self._schema and self._children(schema["properties"][key])
        code = f"[`{key}`](#{key})" if leads else f"`{key}`"
        return f"**{code}**" if key in schema.get("required", []) else code

    def _of(self, model: str) -> _Schema:
        part: _Schema = self._schema if model == self._root.__name__ else self._schema["$defs"][model]
        return part

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
                if len(words) > _MANY:
                    return "one of the kinds below" if self._children(field) else "value"
                return " or ".join(words)
        if "prefixItems" in field:
            return f"list of {len(field['prefixItems'])}: {self._takes(field['prefixItems'][0])}"
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
        """List the models that a field takes, each with what contains it: a mapping, a list or nothing."""
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
        return examples[0] if examples else None


def _models(annotation: Any) -> Iterator[type[BaseModel]]:
    """Yield the models of an annotation, each with those of its fields."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
        for field in annotation.model_fields.values():
            yield from _models(field.annotation)
    for part in branches(annotation).values() if is_tagged(annotation) else get_args(annotation):
        yield from _models(part)


def _keys(model: type[BaseModel]) -> list[str]:
    return [field.alias or name for name, field in model.model_fields.items()]


def _container(container: str, example: Any) -> _Wrap:
    if container == "mapping":
        name = next(iter(example)) if isinstance(example, dict) else "task"
        return lambda content: {name: content}
    return (lambda content: [content]) if container == "list" else (lambda content: content)


def _around(wrap: _Wrap, beside: Mapping[str, Any], key: str, inside: _Wrap) -> _Wrap:
    return lambda content: wrap({**beside, key: inside(content)})


def _title(model: str) -> str:
    words = re.sub(r"(?<!^)(?=[A-Z])", " ", re.sub("(Spec|Facts)$", "", model)).capitalize()
    return {"Qos": "QoS", "Nic": "Network card", "Record": "Record field"}.get(words, words)


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
