"""Figures of a page are computed and asserted in their own stages: a page computes where it draws, and nothing else."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import cellc.mock.report_page as report_page

_FOLDER = Path(report_page.__file__).parent
_DRAWS = {
    "axes.py": None,
    "plots.py": None,
    "html.py": None,
    "run_section.py": ("_bar", "_share", "_time_axis"),
    "sweep_section.py": ("histogram", "_drawn"),
}
"""The functions that place what is drawn; None where a whole module does, or writes texts and units."""
_ARITHMETIC = (ast.Add, ast.Sub, ast.Mult, ast.FloorDiv, ast.Mod, ast.Pow, ast.MatMult)
_COMPUTES = {"sum", "min", "max", "round", "Counter", "fsum", "mean", "median", "divmod", "pow", "nanmin", "nanmax"}


def computations(source: str, drawing: tuple[str, ...]) -> Iterator[str]:
    """Yield what is computed in a module outside of the functions that draw."""
    tree = ast.parse(source)
    left_out = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and node.name in drawing
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        if isinstance(node, (ast.expr, ast.stmt)) and id(node) not in left_out and _computes(node):
            yield f"{node.lineno}: {ast.unparse(node)}"


def _computes(node: ast.AST) -> bool:
    if isinstance(node, ast.AugAssign):
        return isinstance(node.op, (*_ARITHMETIC, ast.Div))
    if isinstance(node, ast.BinOp):
        to_seconds = isinstance(node.op, ast.Div) and ast.unparse(node.right) == "1000000000.0"
        return isinstance(node.op, (*_ARITHMETIC, ast.Div)) and not to_seconds
    if not isinstance(node, ast.Call):
        return False
    called = ast.unparse(node.func).rpartition(".")[2]
    # So many entries as are listed beside it; a list that was made for it alone counts something else.
    return called in _COMPUTES or (called == "len" and not isinstance(node.args[0], (ast.Name, ast.Attribute)))


def test_pages_compute_no_figure() -> None:
    found = {
        file.name: list(computations(file.read_text(encoding="utf-8"), _DRAWS.get(file.name) or ()))
        for file in sorted(_FOLDER.glob("*.py"))
        if _DRAWS.get(file.name, ()) is not None
    }
    assert {name: lines for name, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    "line",
    [
        "sum(run.time_s for run in runs)",
        "len([run for run in runs if run.passed])",
        "good + bad",
        "passed / total",
        "(until_ns - from_ns) / 1e9",
        "np.nanmax(values)",
        "Counter(runs)",
    ],
)
def test_a_computation_is_seen(line: str) -> None:
    assert list(computations(f"def section():\n    return {line}", ("drawn",)))
    assert not list(computations(f"def drawn():\n    return {line}", ("drawn",)))


def test_what_only_prints_computes_nothing() -> None:
    assert not list(computations("f'{at_ns / 1e9:.3f} s of {len(runs)}'", ()))
