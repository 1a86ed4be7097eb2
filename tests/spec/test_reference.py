"""docs/spec.md is the reference of the models: whole, and legal in every example."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.compiler.spec.reference import spec_reference
from cellc.compiler.spec.schema import cell_schema
from tests.cells import ROOT
from tests.foreign_yaml import safe_load
from tests.spec.reading import ARM, as_yaml, parsed

PAGE = (ROOT / "docs" / "spec.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
HEAD = {"format": 1, "cell": "small", "versions": {"ros": "jazzy"}, **safe_load(ARM)}


def test_committed_page_is_the_one_of_the_models() -> None:
    # Written by `cellc schema --reference > docs/spec.md`.
    assert spec_reference() == PAGE


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: " ".join(re.findall(r"\w+", block)[:3]))
def test_example_is_a_part_of_a_legal_spec(block: str, tmp_path: Path) -> None:
    outcome = parsed(as_yaml({**HEAD, **safe_load(block)}), tmp_path)
    assert outcome.ok, [found.message for found in outcome.diagnostics]


def test_every_key_of_every_model_is_told() -> None:
    schema = cell_schema()
    definitions = schema["$defs"]
    assert isinstance(definitions, dict)
    keys = {key for model in (schema, *definitions.values()) for key in _properties(model)}
    assert {key for key in keys if not re.search(rf"`{key}`|[{{ ]{key}: ", PAGE)} == set()


def _properties(model: object) -> list[str]:
    properties = model.get("properties", {}) if isinstance(model, dict) else {}
    assert isinstance(properties, dict)
    return list(properties)


def test_every_link_leads_to_one_heading() -> None:
    headings = [re.sub(r"[^a-z0-9 _-]", "", line.lower()).replace(" ", "-") for line in _headings()]
    assert len(headings) == len(set(headings))
    assert set(re.findall(r"\]\(#([^)]+)\)", PAGE)) <= set(headings)


def _headings() -> list[str]:
    return re.findall(r"^#+ (.+)$", PAGE, re.MULTILINE)
