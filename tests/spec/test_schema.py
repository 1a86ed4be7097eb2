"""The published schemas are those of the models, complete for editors, and judge as the compiler does."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from cellc.compiler.source import Plain
from cellc.compiler.spec.schema import cell_schema, schema_files
from cellc.contract.base import Json
from tests.cells import ROOT
from tests.properties import given, st
from tests.spec.mutations import data_of, mutated
from tests.spec.reading import ARM, CELLS, HEAD, as_yaml, document_of, parsed
from tests.spec.test_parse import CASES

SCHEMA = cell_schema()
FILES = schema_files()


def _is_integer(checker: object, value: object) -> bool:
    # JSON Schema counts 4.0 among the integers, YAML and ROS do not.
    return isinstance(value, int) and not isinstance(value, bool)


def _matches(validator: object, pattern: str, value: object, schema: object) -> Iterator[jsonschema.ValidationError]:
    # JSON Schema's patterns are ECMA-262, whose `$` is the very end; Python's also stands before a last line break.
    if isinstance(value, str) and not re.search(re.sub(r"\$$", r"\\Z", pattern), value):
        yield jsonschema.ValidationError(f"{value!r} does not match {pattern!r}")


_BASE = jsonschema.Draft202012Validator
_EXTEND: Callable[..., type[jsonschema.Draft202012Validator]] = jsonschema.validators.extend
_STRICT = _EXTEND(_BASE, {"pattern": _matches}, type_checker=_BASE.TYPE_CHECKER.redefine("integer", _is_integer))


def schema_accepts(data: Plain) -> bool:
    """Whether a parser that is not ours finds the data legal."""
    return bool(_STRICT(SCHEMA).is_valid(data))


def compiler_accepts(data: Plain) -> bool:
    """Whether the spec stage makes models of the data."""
    with tempfile.TemporaryDirectory() as folder:
        return parsed(as_yaml(data), Path(folder)).ok


@pytest.mark.parametrize("name", sorted(FILES))
def test_committed_schema_is_the_one_of_the_models(name: str) -> None:
    assert (ROOT / "schemas" / name).read_text(encoding="utf-8") == FILES[name]


@pytest.mark.parametrize("name", sorted(FILES))
def test_schema_is_legal(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(json.loads(FILES[name]))


def _fields(schema: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    models = {"": schema, **schema["$defs"]}
    for name, model in models.items():
        for key, value in model.get("properties", {}).items():
            yield f"{name}.{key}", value


def _fields_with_a_whole_example(schema: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    # Examples of mappings show some keys, not all that are required.
    return ((name, field) for name, field in _fields(schema) if not isinstance(field["examples"][0], dict))


def test_field_tells_title_meaning_and_example() -> None:
    for name, field in _fields(SCHEMA):
        assert field["title"], name
        assert field["description"].endswith((".", "?")), name
        assert field["examples"], name
        # What is written as a pattern of units is also said in words.
        assert ("x-units" in field) == ("Units: " in field["description"]), name


def test_example_of_a_field_is_legal() -> None:
    wrong = [
        (name, field["examples"][0])
        for name, field in _fields_with_a_whole_example(SCHEMA)
        if not _STRICT({**field, "$defs": SCHEMA["$defs"]}).is_valid(field["examples"][0])
    ]
    assert wrong == []


def test_schema_names_no_python_type() -> None:
    text = FILES["cell.schema.json"]
    assert not re.search(r'"title": "\w*Spec"|NoneType|"null"', text)


@pytest.mark.parametrize("path", CELLS, ids=lambda path: path.parent.name)
def test_cells_are_legal_for_both(path: Path) -> None:
    assert schema_accepts(data_of(path))
    assert compiler_accepts(data_of(path))


@pytest.mark.parametrize("text", [case[0] for case in CASES])
def test_what_the_compiler_refuses_the_schema_refuses(text: str, tmp_path: Path) -> None:
    assert not schema_accepts(document_of(HEAD + ARM + text, tmp_path).data)


_NUMBERS = r"[-+ ,]{0,2}[0-9.e]{1,4}([ ,]{1,2}-?[0-9.]{1,3}){0,3}"
_QUANTITIES = st.from_regex(_NUMBERS + r" ?(mm|m|deg|rad|s|ms|Hz|%|kg|)\n?", fullmatch=True)
_VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-3, 3),
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from(["", "a", "9", "a-b", "arm/tool0", "a/b/c", "UNKNOWN", "standard", "mock", "a\n", "é", "x" * 501]),
    _QUANTITIES,
    st.lists(st.sampled_from(["a", 5, "a b"]), max_size=2),
    st.dictionaries(
        st.sampled_from(["a", "9", "topic", "move", "at", "x" * 65]), st.sampled_from(["a", 1, {}]), max_size=2
    ),
)


@given(st.sampled_from(CELLS), st.data())
def test_compiler_and_schema_give_one_verdict(path: Path, data: st.DataObject) -> None:
    spec = mutated(path, data, _VALUES)
    assert schema_accepts(spec) == compiler_accepts(spec)


def test_schema_is_the_same_in_every_run() -> None:
    first: Json = cell_schema()
    assert first == cell_schema()


@pytest.mark.parametrize("name", ["contract", "manifest", "rehearsals", "review", "uncertainty", "upgrade"])
def test_field_of_a_generated_file_tells_its_meaning(name: str) -> None:
    schema = json.loads(FILES[f"{name}.schema.json"])
    assert [field for field, value in _fields(schema) if not value.get("description", "").endswith(".")] == []
