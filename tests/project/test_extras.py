"""Nobody imports a package of an extra past `cellc.contract.extras`, so that whoever has none of them gets one line."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping

import pytest

from cellc.contract.extras import EXTRAS, LIVE, MissingExtraError, gate
from tests.cells import ROOT

OPTIONAL = {module for extra in EXTRAS for module in extra.modules}
ENTRIES = re.compile(r"cellc(\.(cli\..*|cli|mock|__main__|mock\.__main__|pipeline|view\..*))?")
"""What a person or a program may import, and what shows a cell: with nothing but the dependencies."""


class _Ungated(ast.NodeVisitor):
    """Collects what a module imports past the gate, and what it does not import for types alone."""

    def __init__(self) -> None:
        self.found: set[str] = set()

    def visit_Import(self, node: ast.Import) -> None:
        self.found |= {alias.name for alias in node.names}

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        self.found |= {node.module or "", *(f"{node.module}.{alias.name}" for alias in node.names)}

    def visit_If(self, node: ast.If) -> None:
        if not (isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"):
            self.generic_visit(node)

    def visit_With(self, node: ast.With) -> None:
        calls = [item.context_expr for item in node.items]
        if not any(
            isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "gate" for call in calls
        ):
            self.generic_visit(node)


def _ungated(text: str) -> set[str]:
    visitor = _Ungated()
    visitor.visit(ast.parse(text))
    return visitor.found


def _needy(imports: Mapping[str, set[str]]) -> dict[str, str]:
    """Return the modules that cannot be imported without an extra, each with one import that needs it."""
    needy: dict[str, str] = {}
    found = True
    while found:
        found = False
        for module, imported in imports.items():
            reason = next((name for name in imported if name.partition(".")[0] in OPTIONAL or name in needy), None)
            if module not in needy and reason is not None:
                needy[module] = reason
                found = True
    return needy


def _imports() -> Iterator[tuple[str, set[str]]]:
    for file in (ROOT / "cellc").rglob("*.py"):
        name = ".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        yield name, _ungated(file.read_text(encoding="utf-8"))


def test_what_people_call_needs_no_extra() -> None:
    needy = _needy(dict(_imports()))
    assert {name: reason for name, reason in needy.items() if ENTRIES.fullmatch(name)} == {}
    # What stays: those that are imported through the gate, and nothing that anybody else imports.
    gated = {"cellc.tools.lsp.features", "cellc.tools.lsp.server", "cellc.mock.command.live", "cellc.mock.command.film"}
    assert set(needy) == gated


def test_an_import_past_the_gate_is_found() -> None:
    assert _needy({"a": _ungated("def f():\n    import mcap.writer"), "b": {"a"}, "c": {"d"}}).keys() == {"a", "b"}
    assert _needy({"a": _ungated("with gate(LIVE):\n    import foxglove"), "b": {"a"}}) == {}
    assert _needy({"a": _ungated("if TYPE_CHECKING:\n    from mcap.records import Schema")}) == {}


def test_extras_are_those_of_the_distribution() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    for extra in EXTRAS:
        line = re.search(rf"^{extra.name} = \[(.*)\]$", text, re.MULTILINE)
        assert line is not None
        assert tuple(re.findall(r'"(.+?)"', line[1])) == extra.requirements


def test_what_is_missing_is_named_with_what_installs_it() -> None:
    with pytest.raises(MissingExtraError) as told, gate(LIVE):
        raise ModuleNotFoundError("No module named 'mcap.reader'", name="mcap.reader")
    text = str(told.value)
    assert text.startswith("`--live` needs the package `mcap`, which is not installed; install it with `")
    assert text.endswith("-m pip install 'foxglove-sdk>=0.30' 'mcap>=1.1'`")


def test_another_missing_module_is_no_matter_of_an_extra() -> None:
    with pytest.raises(ModuleNotFoundError), gate(LIVE):
        raise ModuleNotFoundError("No module named 'numpy'", name="numpy")
