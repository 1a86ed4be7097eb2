"""The tools that hold the project's habits run as tests, so that one command tells everything."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(sys.executable).parent


@pytest.mark.parametrize(
    "command",
    [
        ["ruff", "check", "."],
        ["ruff", "format", "--check", "."],
        # For the Python that runs it: the annotations of numpy are those of one, and mean nothing to another.
        ["mypy", "--python-version", f"{sys.version_info.major}.{sys.version_info.minor}"],
        ["lint-imports"],
    ],
    ids=lambda command: command[0] if command[0] != "ruff" else command[1],
)
def test_tool_finds_nothing(command: list[str]) -> None:
    if command[0] == "mypy" and sys.version_info < (3, 11):
        pytest.skip("the arrays of the last numpy for this Python have other types")
    done = subprocess.run([str(BIN / command[0]), *command[1:]], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
