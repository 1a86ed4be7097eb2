"""Habits that no linter knows: small files and functions, no vendor in Python, light imports."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from statistics import median

import pytest

from cellc.compiler.catalog.load import device_names, load_device
from tests.cells import ROOT

SOURCES = sorted((ROOT / "cellc").rglob("*.py"))
LINES = {file.relative_to(ROOT).as_posix(): len(file.read_text().splitlines()) for file in SOURCES}


def test_no_source_file_is_longer_than_400_lines() -> None:
    assert {name: lines for name, lines in LINES.items() if lines > 400} == {}


def test_no_room_is_above_its_budget() -> None:
    """A room that is not in the table has no lines to spend; one that is far below its budget gives lines back."""
    table = (ROOT / "pyproject.toml").read_text().partition("[tool.cellc.lines]\n")[2].partition("\n\n")[0]
    budgets = {room: int(lines) for room, lines in re.findall(r'^"(.*)" = (\d+)$', table, re.MULTILINE)}
    spent = Counter[str]()
    for name, lines in LINES.items():
        spent["/".join(name.split("/")[1:-1][:2])] += lines
    above = {room: lines for room, lines in spent.items() if lines > budgets.get(room, 0)}
    assert above == {}, "delete as much, or raise the budget in pyproject.toml and say why in the commit"
    assert {room for room, lines in budgets.items() if spent[room] < lines * 0.8 - 100} == set()


def test_median_module_is_of_a_readable_length() -> None:
    assert 100 <= median(lines for lines in LINES.values() if lines > 5) <= 160


def test_no_function_body_is_longer_than_40_lines() -> None:
    long = [f"{file.relative_to(ROOT)}:{line} {name} {size}" for file in SOURCES for name, line, size in _bodies(file)]
    assert long == []


def _bodies(file: Path) -> Iterator[tuple[str, int, int]]:
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            documented = ast.get_docstring(node) is not None and len(node.body) > 1
            first = node.body[1] if documented else node.body[0]
            size = (node.end_lineno or 0) - first.lineno + 1
            if size > 40:
                yield node.name, node.lineno, size


def test_no_module_of_less_than_30_lines_has_a_single_reader() -> None:
    """Such a module belongs into the one that imports it; a rule stands alone because its page does."""
    readers = {file: _readers(file) for file in SOURCES if file.name not in ("__init__.py", "__main__.py")}
    crumbs = [
        f"{file.relative_to(ROOT)} ({lines} lines) is read by {reader}"
        for file, names in readers.items()
        if (lines := LINES[file.relative_to(ROOT).as_posix()]) < 30 and "rules" not in file.parts
        for reader in names
        if len(names) == 1
    ]
    assert not crumbs, f"{len(crumbs)} modules\n" + "\n".join(crumbs)


def _readers(file: Path) -> set[str]:
    name = _module(file)
    return {other for other, imported in _imports().items() if name in imported and other != name}


@cache
def _imports() -> dict[str, set[str]]:
    """Return what every module imports: the modules that are named, and the names that may be modules."""
    found = {}
    for file in SOURCES:
        named: set[str] = set()
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module:
                named |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
            elif isinstance(node, ast.Import):
                named |= {alias.name for alias in node.names}
        found[_module(file)] = named
    return found


def _module(file: Path) -> str:
    return ".".join(file.relative_to(ROOT).with_suffix("").parts)


def test_no_vendor_or_model_stands_in_python() -> None:
    names: set[str] = set()
    for name in device_names():
        device = load_device(name).value
        assert device is not None
        packages = device.model.packages
        names |= {name, device.model.vendor, *filter(None, (packages.driver, packages.sdk, packages.description))}
    pattern = re.compile("|".join(rf"\b{re.escape(name)}" for name in sorted(names)), re.IGNORECASE)
    found = [
        f"{file.relative_to(ROOT)}:{number}: {line.strip()}"
        for file in SOURCES
        for number, line in enumerate(file.read_text().splitlines(), 1)
        if pattern.search(line)
    ]
    assert found == []


@pytest.mark.parametrize(
    "code",
    [
        "import cellc, cellc.tools.cli.main",
        "from cellc.compiler.pipeline import check; assert check('cells/ur5e_pick/cell.yaml').ok",
    ],
    ids=["import", "warm check"],
)
def test_heavy_libraries_are_not_imported(code: str) -> None:
    # The first check computes the cell's geometry and keeps it; the one that counts finds it in the cache.
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)
    heavy = ("pinocchio", "yourdfpy", "trimesh", "matplotlib", "scipy", "ruckig")
    script = f"import sys\n{code}\nprint(sorted(set(sys.modules) & set({heavy!r})))"
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
