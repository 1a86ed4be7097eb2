"""What SECURITY.md promises is held by tests that exist, and README leads to it."""

from __future__ import annotations

import ast
import re

import pytest

from tests.cells import ROOT

PAGE = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
DOORS = ("tests.cli.run", "tests.pull_request.action", "subprocess")
PROMISES = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE.partition("## What is protected")[2].partition("\n## ")[0].splitlines()
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


@pytest.mark.parametrize("promise", PROMISES, ids=lambda promise: promise[1])
def test_each_promise_is_held_through_a_command(promise: list[str]) -> None:
    _, _, held_by = promise
    assert any(_runs_a_command(file, name) for file, name in re.findall(r"`([^`]+)::(\w+)`", held_by))


def _runs_a_command(file: str, name: str) -> bool:
    """Whether a test, with its fixtures and the functions of its file, runs the command line, a step or a process."""
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    imported = {
        alias.asname or alias.name
        for node in tree.body
        if isinstance(node, ast.Import | ast.ImportFrom)
        for alias in node.names
        if (getattr(node, "module", None) or alias.name) in DOORS
    }
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    functions |= {one.removesuffix("_fixture"): node for one, node in functions.items() if one.endswith("_fixture")}
    reached, open_ = set[str](), [name]
    while open_:
        node = functions.get(open_.pop())
        if node is None or node.name in reached:
            continue
        reached.add(node.name)
        used = {inner.id for inner in ast.walk(node) if isinstance(inner, ast.Name)}
        if used & imported:
            return True
        open_ += [*used, *(argument.arg for argument in node.args.args)]
    return False


def test_readme_leads_to_the_page() -> None:
    assert "](SECURITY.md)" in (ROOT / "README.md").read_text(encoding="utf-8")
