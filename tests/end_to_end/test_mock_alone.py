"""The mock needs the generated folder and itself: no spec, no catalog, no stage of the compiler."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from tests.cells import ROOT

# The mock, the format between it and the compiler, and what both use: the reader of URDF, planner, files, processes.
NEEDED = ("mock", "contract", "robot")
MODULES = ("__init__.py", "version.py")


def copy_the_mock(package: Path) -> None:
    """Copy what the mock needs of the package, and nothing else."""
    package.mkdir()
    for name in MODULES:
        shutil.copy(ROOT / "cellc" / name, package)
    for name in NEEDED:
        shutil.copytree(ROOT / "cellc" / name, package / name, ignore=shutil.ignore_patterns("__pycache__"))


def test_mock_runs_a_folder_where_the_compiler_is_absent(pick: Path, tmp_path: Path) -> None:
    copy_the_mock(tmp_path / "cellc")
    shutil.copytree(pick, tmp_path / "folder")
    # The working directory comes first in the search path, so the installed package does not fill in what is absent.
    assert _python(tmp_path, "-c", "import cellc.compiler.spec").returncode == 1
    done = _python(tmp_path, "-m", "cellc.mock", "folder", "--json")
    assert done.returncode == 0, done.stderr
    assert all(one["passed"] for one in json.loads(done.stdout)["rehearsals"])


def _python(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONSAFEPATH")}
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
