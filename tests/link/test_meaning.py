"""What linked cells say, entity by entity, against values written by hand from small specs.

``meaning.yaml`` has them, in SI and radians: a part of what the cell says, things by their names. Nothing rewrites it.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.entity import Entity
from cellc.compiler.cell.members import field_names, members
from tests.cells import CORPUS, graph_of
from tests.foreign_yaml import safe_load

MEANT: dict[str, dict[str, Any]] = safe_load((Path(__file__).parent / "meaning.yaml").read_text(encoding="utf-8"))


@cache
def _cell(spec: str) -> Cell:
    return graph_of(CORPUS / "valid" / f"{spec}.yaml").cell


@pytest.mark.parametrize(("spec", "part"), [(spec, part) for spec, parts in MEANT.items() for part in parts])
def test_part_of_a_cell_says_what_the_spec_means(spec: str, part: str) -> None:
    assert list(_missing(MEANT[spec][part], _plain(getattr(_cell(spec), part)), part)) == []


def _plain(value: Any) -> Any:
    """Return a part of a cell as plain data, a list of named things as a mapping."""
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Entity):
        return {member.name: _plain(member.value) for member in members(value)}
    if names := field_names(value):
        return {name: _plain(getattr(value, name)) for name in names}
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if not isinstance(value, (tuple, list)):
        return value
    listed = list(map(_plain, value))
    known = {entry["name"] for entry in listed if isinstance(entry, dict) and "name" in entry}
    return {entry["name"]: entry for entry in listed} if known and len(known) == len(listed) else listed


def _missing(meant: Any, said: Any, path: str) -> list[str]:
    """Return where a part is not what was meant."""
    if isinstance(meant, dict) and isinstance(said, dict) and meant:
        return [place for key, value in meant.items() for place in _missing(value, said.get(key), f"{path}/{key}")]
    if isinstance(meant, list) and isinstance(said, list) and len(meant) == len(said):
        return [place for at, value in enumerate(meant) for place in _missing(value, said[at], f"{path}/{at}")]
    same = said == (pytest.approx(meant, rel=1e-6) if isinstance(meant, float) else meant)
    return [] if same and (type(meant) is type(said)) else [f"{path}: expected {meant!r}, got {said!r}"]


def test_part_that_is_missing_or_of_another_type_is_told() -> None:
    said = {"a": {"b": 1, "c": [2.0, 3.0]}}
    assert _missing({"a": {"b": 1, "c": [2.0, 3.0]}}, said, "") == []
    assert _missing({"a": {"b": 1.0, "c": [2.0, 4.0], "d": 3}}, said, "") == [
        "/a/b: expected 1.0, got 1",
        "/a/c/1: expected 4.0, got 3.0",
        "/a/d: expected 3, got None",
    ]
