"""Patterns and words of the schemas say in words what they mean: an editor shows nothing else of them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from cellc.compiler.spec.meanings import MEANINGS
from cellc.compiler.spec.schema import cell_schema


def _schemas(schema: Any, key: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    if isinstance(schema, dict):
        yield key, schema
        for name, inner in schema.items():
            if name in ("properties", "$defs"):
                for each, value in inner.items():
                    yield from _schemas(value, each)
            elif name not in ("examples", "default", "enum"):
                yield from _schemas(inner, key)
    elif isinstance(schema, list):
        for inner in schema:
            yield from _schemas(inner, key)


def test_every_pattern_has_a_message_without_a_pattern_in_it() -> None:
    patterns = [schema for _, schema in _schemas(cell_schema()) if isinstance(schema.get("pattern"), str)]
    assert len(patterns) > 300
    for schema in patterns:
        message = schema.get("patternErrorMessage", "")
        assert message.startswith(("write ", "use ")), schema
        assert "[A-Z" not in message


def test_messages_name_the_units_and_an_example() -> None:
    messages = {schema.get("patternErrorMessage") for _, schema in _schemas(cell_schema())}
    assert "write a number and its unit: Hz, kHz or MHz" in messages
    assert "write a number and %" in messages
    assert "use letters, digits and _, beginning with a letter" in messages
    assert any(str(message).startswith("write it as in: ") for message in messages)


def test_words_have_their_meanings_in_their_order() -> None:
    described = {}
    for key, schema in _schemas(cell_schema()):
        if "enumDescriptions" in schema:
            described[key] = dict(zip(map(str, schema["enum"]), schema["enumDescriptions"], strict=True))
    assert set(described) == set(MEANINGS)
    assert all(words.items() <= MEANINGS[key].items() for key, words in described.items())
    assert json.dumps(described)
