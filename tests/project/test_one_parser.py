"""YAML is parsed in few modules, each behind bounds: a parser without them is asked for hours, or ends in an error."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest

from tests.cells import ROOT

_PARSING = {"compose", "load", "parse", "scan"}
_DOORS = {
    "cellc/compiler/source/events.py": "event by event, of which `compose.py` refuses the first that is too much",
    "cellc/robot/description/yaml_values.py": "depth, aliases, values and numbers are bounded before anything is built",
    "cellc/mock/control/parameters/file.py": "aliases and depth are refused as rcl refuses them",
    "cellc/compiler/emit/launch/observe_program.py": "on the robot it has no cellc; it reads files of its package",
    "cellc/compiler/verify/read_back.py": "what cellc itself has just written",
}


def _parses(text: str) -> Iterator[str]:
    """Yield each use of a function of PyYAML that reads."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "yaml":
            yield from (f"from yaml import {alias.name}" for alias in node.names)
        elif isinstance(node, ast.Attribute) and ast.unparse(node.value) == "yaml":
            yield from [f"yaml.{node.attr}"] if _PARSING & set(node.attr.split("_")) else []


def test_yaml_is_parsed_behind_its_doors_alone() -> None:
    found = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "cellc").rglob("*.py")
        if any(_parses(path.read_text(encoding="utf-8")))
    }
    assert found == set(_DOORS)


@pytest.mark.parametrize(
    "text",
    [
        "yaml.safe_load(text)",
        "yaml.load(text, Loader=yaml.SafeLoader)",
        "read = yaml.compose_all",
        "from yaml import C",
    ],
)
def test_what_is_looked_for_is_found(text: str) -> None:
    assert len(list(_parses(text))) == 1


def test_what_only_names_types_or_writes_is_left_alone() -> None:
    assert list(_parses("yaml.YAMLError\nyaml.SafeLoader\nyaml.safe_dump(data)\nself.parse(text)\n")) == []
