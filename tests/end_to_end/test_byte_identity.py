"""One cell, one result: the committed bytes, by every supported interpreter, hash seed, time zone, locale and folder.

Which interpreters besides the running one are held, `CELLC_INTERPRETERS` says (see `interpreters.py`).
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tests.cells import CELLS, EVERY_CELL, ROOT
from tests.end_to_end.interpreters import Interpreter, interpreters

SURROUNDINGS = (
    {"PYTHONHASHSEED": "1", "TZ": "UTC", "LC_ALL": "C"},
    {"PYTHONHASHSEED": "4242", "TZ": "Asia/Kathmandu", "LC_ALL": "C.UTF-8", "COLUMNS": "40", "PYTHONOPTIMIZE": "1"},
)


@pytest.fixture(name="python", params=interpreters(), ids=lambda one: one.version, scope="module")
def python_fixture(request: pytest.FixtureRequest) -> str:
    """Return the path of an interpreter that can import cellc's libraries."""
    interpreter = request.param
    assert isinstance(interpreter, Interpreter)
    if interpreter.why_not:
        pytest.skip(interpreter.why_not)
    return interpreter.path


def test_every_cell_is_built_as_it_is_committed(python: str, tmp_path: Path) -> None:
    # Committed in plain surroundings, built in odd ones.
    _run(python, "build", *(f"cells/{cell}/cell.yaml" for cell in EVERY_CELL), "-o", str(tmp_path), **SURROUNDINGS[1])
    built, committed = _files(tmp_path), _files(ROOT / "generated")
    assert built.keys() == committed.keys()
    # Names first: the bytes of many files are no readable message.
    assert [name for name in built if built[name] != committed[name]] == []


def test_findings_are_the_same(python: str) -> None:
    cells = [f"cells/{cell}/cell.yaml" for cell in CELLS]
    running = next(interpreter for interpreter in interpreters() if interpreter.path and not interpreter.why_not)
    arguments = ("check", *cells, "--format", "json")
    assert _run(python, *arguments, **SURROUNDINGS[1]) == _run(running.path, *arguments, **SURROUNDINGS[0])


def _run(python: str, *arguments: str, **surroundings: str) -> str:
    # Without the cache: an answer that another interpreter kept would prove nothing.
    environment = os.environ | surroundings | {"CELLC_NO_CACHE": "1"}
    done = subprocess.run(
        [python, "-m", "cellc", *arguments], cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def _files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
