"""What every refusal has in common."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.cells import ROOT
from tests.cli.run import Ran

UNWRITABLE = (70,)
"""The exit code where the system refuses to write a file."""


def assert_refused(ran: Ran, words: str, codes: tuple[int, ...] = (1, 2)) -> None:
    """Hold that a command ended with a diagnostic that holds the words, and not with a traceback."""
    told = ran.out + ran.err
    assert ran.code in codes, told
    assert words in told
    assert "Traceback" not in told


def process(*arguments: str, cwd: Path = ROOT, module: str = "cellc", **environment: str) -> Ran:
    """Run a module of cellc as a process of its own."""
    done = subprocess.run(
        [sys.executable, "-m", module, *arguments],
        cwd=cwd,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | environment,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=600,
        check=False,
    )
    return Ran(done.returncode, done.stdout, done.stderr)


def everything_below(folder: Path) -> list[str]:
    """Name every file and folder, hidden ones too."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*"))
