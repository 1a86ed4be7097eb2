"""JSON Schema of the spec language, made from the models so that editors and the compiler give one verdict."""

from __future__ import annotations

import json
from collections.abc import Mapping

from pydantic import BaseModel

from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.meanings import meaning_of_word
from cellc.compiler.spec.plant import PlantSpec
from cellc.compiler.spec.wording import rule_of
from cellc.contract.base import DIALECT, Json, contract_schema
from cellc.contract.contract import Contract
from cellc.contract.fleet import Fleet
from cellc.contract.manifest import Manifest
from cellc.contract.rehearsals import Rehearsals
from cellc.contract.review import Review
from cellc.contract.uncertainty import Uncertainty
from cellc.contract.upgrade import Upgrade


def cell_schema() -> dict[str, Json]:
    """Return the JSON Schema (2020-12) of ``cell.yaml``."""
    return _spec_schema(CellSpec, "Cell spec")


def _spec_schema(model: type[BaseModel], title: str) -> dict[str, Json]:
    """Return the schema of a spec.

    Each field carries title, description and example; a quantity also its units, in ``x-units``.
    """
    schema = tidy(model.model_json_schema())
    assert isinstance(schema, dict)
    properties = schema["properties"]
    assert isinstance(properties, dict)
    # Reading splits a spec into files by `include`, which is gone before the models see the data.
    properties["include"] = {
        "title": "Include",
        "description": "Relative paths of files whose sections are merged into this one.",
        "examples": ["parts/devices.yaml"],
        "anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}],
    }
    return {"$schema": DIALECT, **schema, "title": title}


def schema_files() -> Mapping[str, str]:
    """Return the text of every published schema by file name."""
    contracts: tuple[tuple[str, type[BaseModel]], ...] = (
        ("contract", Contract),
        ("fleet", Fleet),
        ("manifest", Manifest),
        ("rehearsals", Rehearsals),
        ("review", Review),
        ("upgrade", Upgrade),
        ("uncertainty", Uncertainty),
    )
    schemas = {"cell.schema.json": cell_schema(), "plant.schema.json": _spec_schema(PlantSpec, "Plant spec")}
    schemas |= {f"{name}.schema.json": contract_schema(model) for name, model in contracts}
    return {name: json.dumps(schema, indent=2, ensure_ascii=False) + "\n" for name, schema in schemas.items()}


def tidy(schema: Json) -> Json:
    """Return a schema without what only pydantic reads: null of absent keys, names of classes, patterns of keys."""
    if isinstance(schema, list):
        return [tidy(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    # Examples and defaults are data of the user's, not schemas; a property may have their name.
    inner = {key: value if key in ("examples", "default", "enum") else tidy(value) for key, value in schema.items()}
    properties = schema.get("properties")
    if isinstance(properties, dict):
        inner["properties"] = {key: _with_meanings(key, tidy(value)) for key, value in properties.items()}
    return _with_messages(_with_unit_notes(_titled(_one_of_scalars(_keys_checked(_without_null(inner))))))


def _without_null(schema: dict[str, Json]) -> dict[str, Json]:
    """An optional key is left out, never null: an empty value is reported by the compiler."""
    options = schema.get("anyOf")
    if not isinstance(options, list) or {"type": "null"} not in options:
        return schema
    present = [option for option in options if option != {"type": "null"}]
    without = {key: value for key, value in schema.items() if key != "anyOf" and (key, value) != ("default", None)}
    if len(present) == 1 and isinstance(present[0], dict):
        return {**present[0], **without}
    return {**without, "anyOf": present}


def _keys_checked(schema: dict[str, Json]) -> dict[str, Json]:
    """A pattern of keys alone lets every other key pass: check the names, and all values."""
    patterns = schema.get("patternProperties")
    if not isinstance(patterns, dict) or len(patterns) != 1:
        return schema
    ((pattern, values),) = patterns.items()
    names = schema.get("propertyNames")
    checked = {key: value for key, value in schema.items() if key != "patternProperties"}
    names = _with_messages({**(names if isinstance(names, dict) else {}), "pattern": pattern})
    return {**checked, "additionalProperties": values, "propertyNames": names}


def _one_of_scalars(schema: dict[str, Json]) -> dict[str, Json]:
    """`1` is an integer and a number: exactly one of both would refuse it."""
    options = schema.get("oneOf")
    if not isinstance(options, list) or {"type": "number"} not in options:
        return schema
    return {**{key: value for key, value in schema.items() if key != "oneOf"}, "anyOf": options}


def _titled(schema: dict[str, Json]) -> dict[str, Json]:
    """Editors show titles: no Python class names, and one for each property that is a reference."""
    title = schema.get("title")
    if isinstance(title, str) and title.endswith("Spec"):
        schema = {**schema, "title": title.removesuffix("Spec")}
    properties = schema.get("properties")
    if not isinstance(properties, dict):
        return schema
    titled: dict[str, Json] = {
        key: {"title": key.replace("_", " ").capitalize(), **value} if isinstance(value, dict) else value
        for key, value in properties.items()
    }
    return {**schema, "properties": titled}


def _with_unit_notes(schema: dict[str, Json]) -> dict[str, Json]:
    units, description = schema.get("x-units"), schema.get("description")
    if not isinstance(units, list) or not isinstance(description, str) or " Units: " in description:
        return schema
    return {**schema, "description": f"{description} Units: {', '.join(str(unit) for unit in units)}."}


def _with_messages(schema: dict[str, Json]) -> dict[str, Json]:
    """Editors show `patternErrorMessage` in the place of the pattern."""
    pattern, units, examples = (schema.get(key) for key in ("pattern", "x-units", "examples"))
    if not isinstance(pattern, str) or "patternErrorMessage" in schema:
        return schema
    message = rule_of(pattern).replace("`", "")
    if isinstance(examples, list) and "A-Za-z_]" not in pattern:
        message = f"write it as in: {examples[0]}"
    if isinstance(units, list):
        *others, last = (str(unit) for unit in units)
        message = (
            f"write a number and its unit: {', '.join(others)} or {last}" if others else f"write a number and {last}"
        )
    return {**schema, "patternErrorMessage": message}


def _with_meanings(key: str, schema: Json) -> Json:
    """Editors show beside each word of a closed list what it means."""
    if not isinstance(schema, dict):
        return schema
    words = schema.get("enum")
    if isinstance(words, list):
        meanings: list[Json] = [meaning_of_word(key, str(word)) for word in words]
        return {**schema, "enumDescriptions": meanings} if all(meanings) else schema
    inner = schema.get("items")
    return schema if inner is None else {**schema, "items": _with_meanings(key, inner)}
