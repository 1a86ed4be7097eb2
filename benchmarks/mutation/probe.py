"""Which tests execute which statement: a plugin of pytest, and what it writes into a copy of the sources.

A probe is before each statement of a function. It notes the test that runs, from the variable that pytest sets for
processes that a test starts too. Each file of tests runs in a process of its own: what is built once and kept for a
session is built again, so that each file reaches what it rests on.
"""

from __future__ import annotations

import ast
import json
import os
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

_CALLED = '''"""Notes which test executes a statement; only in a copy of the sources."""
import os

seen = bytearray({count})
opened = {{}}

def hit(number):
    seen[number] = 1
    test, file = os.environ.get("PYTEST_CURRENT_TEST"), os.environ.get("CELLC_MUTANTS_HITS")
    if test and file:
        if file not in opened:
            opened[file] = open(file, "ab", buffering=0)
        opened[file].write(f"{{number}} {{test}}\\n".encode())
'''


def plant(folder: Path) -> list[tuple[str, int]]:
    """Write probes into every source of a copy, and return the place of each."""
    places: list[tuple[str, int]] = []
    for file in sorted((folder / "cellc").rglob("*.py")):
        if file.match("emit/*/*_program.py"):  # its text is copied into packages and run there
            continue
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
        tree = ast.parse("".join(lines))
        before: dict[int, str] = {}
        for line, column in statements("".join(lines).encode()):
            before[line] = f"{' ' * column}_seen[{len(places)}] or _hit({len(places)})\n"
            places.append((file.relative_to(folder).as_posix(), line))
        if before:
            before[_first(tree)] = "from cellc._probes import hit as _hit, seen as _seen\n"
            file.write_text("".join(before.get(at, "") + line for at, line in enumerate(lines, 1)), encoding="utf-8")
    (folder / "cellc" / "_probes.py").write_text(_CALLED.format(count=len(places)), encoding="utf-8")
    return places


def statements(source: bytes) -> list[tuple[int, int]]:
    """Return line and column of each statement in functions that a probe can stand before."""
    return sorted(set(_statements(ast.parse(source))))


def _statements(node: ast.AST, inside: bool = False) -> Iterator[tuple[int, int]]:
    named = isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    for name, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.stmt) and (inside or named) and not _has_no_place(node, name, child):
                first = child.decorator_list[0].lineno if getattr(child, "decorator_list", []) else child.lineno
                yield first, child.col_offset
            if isinstance(child, ast.AST) and not isinstance(child, ast.expr):
                yield from _statements(child, inside or named)


def _has_no_place(parent: ast.AST, field: str, statement: ast.stmt) -> bool:
    """Tell whether a line cannot go before a statement: a docstring, an ``elif``, what follows a colon."""
    if isinstance(parent, ast.ClassDef) or (isinstance(statement, ast.Expr) and _is_text(statement.value)):
        return True
    if isinstance(parent, ast.If) and field == "orelse" and isinstance(statement, ast.If):
        return statement.col_offset == parent.col_offset
    return statement.lineno == getattr(parent, "lineno", 0)


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _first(tree: ast.Module) -> int:
    """Return the line of the first statement after the docstring and what is imported of the future."""
    for node in tree.body:
        future = isinstance(node, ast.ImportFrom) and node.module == "__future__"
        if not future and not (isinstance(node, ast.Expr) and _is_text(node.value)):
            decorators = getattr(node, "decorator_list", [])
            return int(decorators[0].lineno if decorators else node.lineno)
    raise ValueError("a module without statements")


class Recorder:
    """A plugin of pytest: records time and failures of each test, and clears the probes before each."""

    def __init__(self, seconds: float) -> None:
        self._until = _spent() + seconds
        self.took: dict[str, float] = defaultdict(float)
        self.failed: set[str] = set()

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        if _spent() > self._until:
            item.session.shouldstop = "the rest is not asked"
        probes = sys.modules.get("cellc._probes")
        if probes is not None:
            probes.seen[:] = bytes(len(probes.seen))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.took[report.nodeid] += report.duration
        if report.failed:
            self.failed.add(report.nodeid)


def record(recorder: Recorder, hits: Path, places: list[tuple[str, int]], kept: Path) -> None:
    """Write down which statements each test of a file executes."""
    executed: dict[str, set[int]] = defaultdict(set)
    for line in hits.read_text(encoding="utf-8").splitlines():
        number, _, test = line.partition(" ")
        executed[test.rpartition(" (")[0]].add(int(number))
    tests = {test: round(took, 3) for test, took in recorder.took.items() if test not in recorder.failed}
    statements = {test: sorted(executed[test]) for test in tests}
    used = sorted({number for numbers in statements.values() for number in numbers})
    content = {"took": tests, "executed": statements, "places": {number: places[number] for number in used}}
    kept.write_text(json.dumps(content | {"failed": sorted(recorder.failed)}), encoding="utf-8")


def _spent() -> float:
    """Return the seconds of the processor that this process and its children took."""
    return sum(os.times()[:4])
