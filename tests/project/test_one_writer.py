"""Files are written in two modules of the store and read in another: what is safe there is safe in every command."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest

from tests.cells import ROOT

_WRITERS = ("cellc/contract/store/staging.py", "cellc/contract/store/swap.py")
_READER = "cellc/contract/store/regular_file.py"
_ELSEWHERE = {
    "cellc/compiler/emit/launch/bring_up_program.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/claim_watch_program.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/first_goal_program.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/installed_versions.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/observe_host.py": "it runs on the robot's host, without cellc",
    "cellc/compiler/emit/launch/observe_program.py": "it runs on the robot's host, without cellc",
    "cellc/contract/printing.py": "it opens the null device in the place of a closed stream",
    "cellc/contract/signals.py": "it opens the null device, as the process ends",
}
_WRITING_METHODS = {
    *("chmod", "hardlink_to", "lchmod", "link_to", "mkdir", "rename", "rmdir", "symlink_to", "touch", "unlink"),
    *("write_bytes", "write_text"),
}
_WRITING = {
    "os": {
        *("chmod", "chown", "link", "makedirs", "mkdir", "mkfifo", "mknod", "remove", "removedirs", "rename"),
        *("renames", "replace", "rmdir", "symlink", "truncate", "unlink"),
    },
    "shutil": {"*"},
    "tempfile": {"*"},
}
_HARMLESS = {("shutil", "get_terminal_size"), ("shutil", "which")}
_READING_METHODS = {"read_bytes", "read_text"}
_READING = {
    "ElementTree": {"parse", "iterparse"},
    "codecs": {"open"},
    "fileinput": {"*"},
    "io": {"open", "open_code"},
    "linecache": {"*"},
    "mmap": {"*"},
    "np": {"fromfile", "genfromtxt", "load", "loadtxt", "memmap"},
    "tarfile": {"*"},
}
_EITHER = {("os", "open")}


def _kinds(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield line, kind and name of each call that writes, reads, or may do either."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module in ("os", *_WRITING, *_READING):
            for alias in node.names:
                yield from _of_module(node.lineno, node.module, alias.name)
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            yield from _of_module(node.lineno, node.value.id, node.attr)
        if isinstance(node, ast.Call):
            yield from _of_call(node)


def _of_module(line: int, module: str, name: str) -> Iterator[tuple[int, str, str]]:
    if (module, name) in _EITHER:
        yield line, "either", f"{module}.{name}"
    elif (module, name) not in _HARMLESS:
        for kind, known in (("writes", _WRITING), ("reads", _READING)):
            if not {name, "*"}.isdisjoint(known.get(module, ())):
                yield line, kind, f"{module}.{name}"


def _of_call(call: ast.Call) -> Iterator[tuple[int, str, str]]:
    called = call.func
    if isinstance(called, ast.Name) and called.id == "open":
        yield call.lineno, _of_mode(call, 1), "open"
    elif getattr(called, "attr", getattr(called, "id", "")) == "FileIO":
        yield call.lineno, _of_mode(call, 1), "FileIO"
    elif isinstance(called, ast.Attribute):
        if called.attr in _WRITING_METHODS or (called.attr == "replace" and len(call.args) + len(call.keywords) == 1):
            yield call.lineno, "writes", f".{called.attr}"
        elif called.attr in _READING_METHODS:
            yield call.lineno, "reads", f".{called.attr}"
        elif called.attr == "open" and _opens_a_path(call):
            yield call.lineno, _of_mode(call, 0), ".open"


def _opens_a_path(call: ast.Call) -> bool:
    first = (
        call.args[0] if call.args else next((keyword.value for keyword in call.keywords if keyword.arg == "mode"), None)
    )
    return first is None or (isinstance(first, ast.Constant) and set(str(first.value)) <= set("rwaxbt+"))


def _of_mode(call: ast.Call, place: int) -> str:
    given = [keyword.value for keyword in call.keywords if keyword.arg == "mode"] + call.args[place : place + 1]
    if not given:
        return "reads"
    mode = given[0].value if isinstance(given[0], ast.Constant) else "w"
    return "reads" if set(str(mode)) <= set("rbt") else "writes"


def test_files_are_written_and_read_in_their_modules_alone() -> None:
    allowed = {**{file: {"writes", "either"} for file in _WRITERS}, _READER: {"reads", "either"}}
    found = {
        f"{name}:{line} {what} {kind}"
        for path in sorted((ROOT / "cellc").rglob("*.py"))
        if (name := path.relative_to(ROOT).as_posix()) not in _ELSEWHERE
        for line, kind, what in _kinds(path.read_text(encoding="utf-8"))
        if kind not in allowed.get(name, set())
    }
    assert found == set()


def test_each_exception_is_one() -> None:
    needed = {name for name in _ELSEWHERE if any(_kinds((ROOT / name).read_text(encoding="utf-8")))}
    assert needed == set(_ELSEWHERE)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("open(a, 'w')", "writes"),
        ("open(a, mode=m)", "writes"),
        ("path.open('r+b')", "writes"),
        ("io.FileIO(a, 'w')", "writes"),
        ("path.write_text(a)", "writes"),
        ("path.replace(other)", "writes"),
        ("os.makedirs(a)", "writes"),
        ("from shutil import rmtree", "writes"),
        ("with tempfile.TemporaryDirectory(): pass", "writes"),
        ("open(a)", "reads"),
        ("path.open()", "reads"),
        ("path.open('rb')", "reads"),
        ("path.read_bytes()", "reads"),
        ("ElementTree.parse(a)", "reads"),
        ("os.open(a, flags)", "either"),
    ],
)
def test_what_is_looked_for_is_found(text: str, kind: str) -> None:
    assert [found for _, found, _ in _kinds(text)] == [kind]


def test_what_opens_no_file_is_left_alone() -> None:
    assert list(_kinds("a.replace('b', 'c')\nreplace(a, b=1)\narchive.open(_NAME)\nshutil.get_terminal_size()\n")) == []
