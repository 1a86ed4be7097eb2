"""Emitters decide nothing: they hold no number but 0 and 1, places in lists apart, so that no default is theirs."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from tests.cells import ROOT

EMIT = ROOT / "cellc" / "compiler" / "emit"
DRAWN = {"node_graph.py", "responsibility_graph.py", "rviz.py"}
"""Sizes and gaps of what is drawn."""
STATED = {
    "gates.py": {80},  # characters of a line of commands that a page of A4 shows whole
    "contract/uncertainty.py": {3, 8},  # ISO 9283, and the three axes
    "middleware/profiles.py": {7447},  # the port that Zenoh has by default
    "moveit.py": {0.005, 0.01, 0.1, 0.2, 0.5, 1.2, 4, 5, 6},  # what the setup assistant of MoveIt writes
}
"""Numbers of a standard, or of the program that reads the file, by module."""


def numbers(source: str) -> Iterator[float]:
    """Yield the numbers of a module beside 0 and 1; neither places in lists nor the format of a file is one."""
    tree = ast.parse(source)
    places = {id(leaf) for node in ast.walk(tree) if isinstance(node, ast.Subscript) for leaf in ast.walk(node.slice)}
    formats = {id(word.value) for word in ast.walk(tree) if isinstance(word, ast.keyword) and word.arg == "format"}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and type(node.value) in (int, float) and id(node) not in places | formats:
            assert isinstance(node.value, (int, float))
            if node.value not in (0, 1):
                yield node.value


def modules() -> Iterator[tuple[str, Path]]:
    """Yield the emitters; the programs that they copy run on the computers of the cell, and are no emitters."""
    for file in sorted(EMIT.rglob("*.py")):
        if file.name not in DRAWN and not file.read_text(encoding="utf-8").startswith("#!"):
            yield file.relative_to(EMIT).as_posix(), file


def test_emitters_hold_no_number_of_their_own() -> None:
    found = {name: set(numbers(file.read_text(encoding="utf-8"))) for name, file in modules()}
    assert {name: values for name, values in found.items() if values} == STATED


def test_a_default_in_an_emitter_would_be_found() -> None:
    assert list(numbers("rate_hz = interface.rate_hz or 30.0\nformat(first[2], format=2)\n")) == [30.0]
