"""Nobody prints past `cellc.contract.printing`, which escapes what comes from strangers."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from tests.cells import ROOT

_DOOR = "cellc/contract/printing.py"
_PAST_IT = {
    "cellc/tools/cli/lsp.py": "it leads what pygls logs through the door",
    "cellc/robot/description/mesh_child.py": "the child process answers its parent there, in numbers",
    "cellc/robot/description/xacro_expansion.py": "the child process answers its parent there, and nobody reads it",
    "cellc/compiler/emit/launch/bring_up_program.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/claim_watch_program.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/first_goal_program.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/installed_versions.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/observe_program.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/required_program.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/verify/parsers.py": "it takes the loggers of foreign parsers off the terminal",
    "cellc/contract/signals.py": "one line of its own, past the buffers of a program that was stopped anywhere",
}
_PRINTING = {
    "click": {"echo", "secho", "style", "echo_via_pager", "progressbar", "confirm", "prompt", "get_text_stream"},
    "logging": {"*"},
    "os": {"write"},
    "sys": {"stdout", "stderr", "__stdout__", "__stderr__", "displayhook"},
    "traceback": {"*"},
    "warnings": {"warn", "warn_explicit"},
}
_CALLS = {"print", "input", "breakpoint"}


def _prints(text: str) -> Iterator[tuple[int, str]]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Name) and node.id in _CALLS:
            yield node.lineno, node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            names = _PRINTING.get(node.value.id, set())
            if node.attr in names or "*" in names:
                yield node.lineno, f"{node.value.id}.{node.attr}"
        elif isinstance(node, ast.ImportFrom):
            names = _PRINTING.get(node.module or "", set())
            for alias in node.names:
                if alias.name in names or "*" in names:
                    yield node.lineno, f"{node.module}.{alias.name}"


def _file(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def test_nobody_prints_but_the_door() -> None:
    sources = {_file(path): path.read_text() for path in sorted((ROOT / "cellc").rglob("*.py"))}
    found = {
        f"{name}:{line} {what}"
        for name, text in sources.items()
        if name != _DOOR and name not in _PAST_IT
        for line, what in _prints(text)
    }
    assert found == set()


def test_what_is_looked_for_is_found() -> None:
    text = "from sys import stderr\nprint(1)\nclick.echo(2)\nsys.stdout.write('')\nos.write(1, b'')\nshow = print\n"
    assert [line for line, _ in sorted(_prints(text))] == [1, 2, 3, 4, 5, 6]
    assert list(_prints("sys.argv\nshow('print')\nfile.write('a')\n")) == []
