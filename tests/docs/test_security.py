"""What SECURITY.md promises is held by tests that exist, and README leads to it."""

from __future__ import annotations

import ast
import re

import pytest

from tests.cells import ROOT

PAGE = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
PROMISES = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE.partition("## What is promised")[2].partition("\n## ")[0].splitlines()
    if line.startswith("|") and not line.startswith("|---")
][1:]


@pytest.mark.parametrize("promise", PROMISES, ids=lambda promise: promise[1])
def test_each_promise_names_tests_that_exist(promise: list[str]) -> None:
    _, _, held_by = promise
    named = re.findall(r"`([^`]+)::(\w+)`", held_by)
    assert named
    for file, name in named:
        tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
        assert name in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}, file


def test_readme_leads_to_the_page() -> None:
    assert "](SECURITY.md)" in (ROOT / "README.md").read_text(encoding="utf-8")
