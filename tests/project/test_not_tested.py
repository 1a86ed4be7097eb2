"""What is skipped is said in one line at the end of a run, whoever runs the tests."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT

_TESTS = """
import pytest

absent = pytest.mark.skipif(True, reason="the files are not here")

@absent
@pytest.mark.parametrize("number", range(3))
def test_of_files(number): ...

@pytest.mark.skipif(True, reason="no browser here")
def test_of_pages(): ...

def test_that_runs(): ...
"""


@pytest.mark.parametrize("options", [(), ("-n", "1")], ids=["alone", "workers"])
def test_run_ends_by_what_was_not_tested_and_why(options: tuple[str, ...], tmp_path: Path) -> None:
    for name in ("some", "other"):
        (tmp_path / "tests" / name).mkdir(parents=True)
        (tmp_path / "tests" / name / f"test_{name}.py").write_text(_TESTS, encoding="utf-8")
    (tmp_path / "pyproject.toml").write_text("[tool.pytest.ini_options]\n", encoding="utf-8")
    shutil.copy(ROOT / "tests" / "conftest.py", tmp_path / "tests")
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "tests", *options]
    ran = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    told = [line for line in ran.stdout.splitlines() if line.startswith("not tested")]
    assert told == [
        "not tested: 8 tests, 3 of tests/other, 3 of tests/some (the files are not here); "
        "1 of tests/other, 1 of tests/some (no browser here)"
    ]
