"""The same folder and seed give the same bytes: again, in another process, and with another Python."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cellc.mock import MockCell
from tests.cells import ROOT
from tests.mock.conftest import Written, write_evidence

NEEDED = "click, mcap, numpy, pinocchio, pydantic, ruckig, yaml"
VERSIONS = ("3.10", "3.11", "3.12", "3.13")


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def written_by(python: str, built_folder: Path, folder: Path, **environment: str) -> dict[str, bytes]:
    """Run the mock in a process of its own and return what it wrote."""
    subprocess.run(
        [python, "-m", "cellc.mock", str(built_folder), "--evidence", str(folder)],
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        cwd=folder.parent,
        check=True,
        capture_output=True,
    )
    return contents(folder)


def test_second_run_writes_the_same_bytes(written: Written, cell: MockCell, tmp_path: Path) -> None:
    assert contents(write_evidence(cell, tmp_path / "again").folder) == contents(written.folder)


@pytest.mark.parametrize("hash_seed", ["0", "4242"])
def test_other_process_writes_the_same_bytes(
    hash_seed: str, written: Written, built_folder: Path, tmp_path: Path
) -> None:
    other = written_by(sys.executable, built_folder, tmp_path / "other", PYTHONHASHSEED=hash_seed, TZ="Asia/Tokyo")
    assert other == contents(written.folder)


def test_other_pythons_write_the_same_bytes(written: Written, built_folder: Path, tmp_path: Path) -> None:
    """Told by CELLC_PYTHONS, a list of interpreters as in PATH; else those of other versions that are found.

    Plans are computed with numpy, whose linear algebra may round otherwise from one release to the next.
    """
    here = _versions(sys.executable)
    others = [
        python for python in _pythons() if (told := _versions(python)) and told[0] != here[0] and told[1] == here[1]
    ]
    if not others:
        pytest.skip("no other Python here has what the mock needs, with the same release of numpy")
    for number, python in enumerate(others):
        assert written_by(python, built_folder, tmp_path / f"python-{number}") == contents(written.folder)


def _pythons() -> Iterator[str]:
    told = os.environ.get("CELLC_PYTHONS", "")
    found = told.split(os.pathsep) if told else [shutil.which(f"python{version}") for version in VERSIONS]
    yield from (python for python in found if python)


def _versions(python: str) -> tuple[str, ...]:
    """Return the versions of Python and numpy; nothing where a package is missing."""
    told = f"import sys, {NEEDED}; print(*sys.version_info[:2], sep='.'); print(numpy.__version__)"
    ran = subprocess.run([python, "-c", told], capture_output=True, text=True, check=False)
    return tuple(ran.stdout.split()) if ran.returncode == 0 else ()
