"""Every number of the language has a bound, is held by a rule, or is free for a stated reason."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest

from cellc.compiler.pipeline import check
from cellc.compiler.rules.bounds import Bound
from cellc.compiler.rules.kit import FAMILIES
from cellc.compiler.rules.run import ALL_RULES
from cellc.compiler.spec.schema import cell_schema
from cellc.contract.base import Json
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import YamlPath
from tests.rules.examples import Example, diagnose_example
from tests.rules.quantities import BY_RULES, FREE, WRONG

_ALIKE = (
    (r"^managers\.\*\.", "control."),
    (r"\.inject\.\*\.", ".inject."),
    (r"^bringup\.first_motion\.\*\.", "bringup.first_motion."),
    (r"^(interfaces\.\*)\.(to|client)\.", r"\1.from."),
    (r"\.(goal|path)_tolerance\.\*$", r".\1_tolerance"),
)
"""Places in which one model stands several times."""


def alike(key: str) -> str:
    for pattern, instead in _ALIKE:
        key = re.sub(pattern, instead, key)
    return key


def tables() -> Iterator[Bound]:
    for family in FAMILIES:
        package = import_module(f"cellc.compiler.rules.{family}")
        for topic in iter_modules(package.__path__):
            yield from vars(import_module(f"{package.__name__}.{topic.name}")).get("BOUNDS", ())


BOUNDED = {alike(key) for bound in tables() for key in bound.keys}


def numbers(schema: dict[str, Json]) -> set[str]:
    """Return the place of every number of a schema: what has units, and what is a number without one."""
    definitions = schema.get("$defs", {})
    assert isinstance(definitions, dict)

    def walk(node: Json, path: tuple[str, ...]) -> Iterator[str]:
        assert isinstance(node, dict)
        if "$ref" in node:
            yield from walk(definitions[str(node["$ref"]).rpartition("/")[2]], path)
            return
        if "x-units" in node or node.get("type") in ("integer", "number"):
            yield alike(".".join(path))
        for union in ("anyOf", "oneOf", "allOf"):
            for choice in _list(node.get(union)):
                yield from walk(choice, path)
        if "items" in node:
            yield from walk(node["items"], (*path, "*"))
        for name, inner in _dict(node.get("properties")).items():
            yield from walk(inner, (*path, name))
        more = [node.get("additionalProperties"), *_dict(node.get("patternProperties")).values()]
        for inner in more:
            if isinstance(inner, dict):
                yield from walk(inner, (*path, "*"))

    return set(walk(dict(schema), ()))


def _list(node: Json) -> list[Json]:
    return node if isinstance(node, list) else []


def _dict(node: Json) -> dict[str, Json]:
    return node if isinstance(node, dict) else {}


def unheld(schema: dict[str, Json]) -> set[str]:
    return numbers(schema) - BOUNDED - {alike(key) for key in BY_RULES} - set(FREE)


def test_every_number_of_the_language_is_held_or_free() -> None:
    assert unheld(cell_schema()) == set()


def test_a_key_that_is_added_without_an_entry_is_missed() -> None:
    schema = cell_schema()
    properties = _dict(schema["properties"])
    properties["new_length"] = {"type": "string", "x-units": ["mm"]}
    properties["new_count"] = {"type": "array", "items": {"type": "integer"}}
    assert unheld(schema) == {"new_length", "new_count.*"}


def test_what_is_held_or_free_is_in_the_language_and_in_one_list() -> None:
    held, free = BOUNDED | {alike(key) for key in BY_RULES}, set(FREE)
    assert held | free <= numbers(cell_schema())
    assert not free & held
    assert all(len(reason) > len("a counter") for reason in FREE.values())


def test_rules_that_hold_a_number_exist() -> None:
    codes = {rule.code for rule in ALL_RULES} | {code for stage in STAGES.values() for code in stage}
    assert {code for codes_of in BY_RULES.values() for code in codes_of} <= codes


def place(path: YamlPath) -> str:
    """Return the key in the schema of the place of a finding."""
    words = [str(part) for part in path]
    for key in BOUNDED:
        pattern = key.split(".")
        for got in (words, [word for word, part in zip(words, path, strict=True) if not isinstance(part, int)]):
            if len(pattern) == len(got) and all(want in ("*", one) for want, one in zip(pattern, got, strict=True)):
                return key
    return ".".join(words)


@pytest.mark.parametrize(("text", "keys"), WRONG, ids=[keys.partition(" ")[0] for _, keys in WRONG])
def test_wrong_figures_are_reported_at_each_of_them(text: str, keys: str, folder: Path) -> None:
    found = diagnose_example(Example("yaml", text), folder)
    graph = check(folder / "cell.yaml").graph
    assert graph is not None, [str(item) for item in found]
    told = {place(finding.path) for rule in ALL_RULES if rule.gives_way for finding in rule.check(graph)}
    assert told == set(keys.split())


def test_every_bound_has_a_wrong_figure() -> None:
    assert {key for _, keys in WRONG for key in keys.split()} == BOUNDED
