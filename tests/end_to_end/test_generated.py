"""`generated/` is the golden record: every cell is built into a temporary folder and compared both ways."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CELLS = sorted(path.parent.name for path in (ROOT / "cells").glob("*/cell.yaml"))


def build(cell: str, output: Path, **environment: str) -> dict[str, bytes]:
    """Build a cell in a process of its own and return its files."""
    subprocess.run(
        [sys.executable, "-m", "cellc", "build", f"cells/{cell}/cell.yaml", "-o", str(output)],
        cwd=ROOT,
        env=os.environ | environment,
        check=True,
        capture_output=True,
    )
    return files(output / cell)


def files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("cell", CELLS)
def test_generated_folder_is_what_the_cell_makes(cell: str, tmp_path: Path) -> None:
    assert build(cell, tmp_path) == files(ROOT / "generated" / cell)


@pytest.mark.parametrize("cell", CELLS)
def test_build_is_the_same_under_another_hash_seed_time_zone_and_locale(cell: str, tmp_path: Path) -> None:
    first = build(cell, tmp_path / "a", PYTHONHASHSEED="1", TZ="UTC", LC_ALL="C")
    second = build(cell, tmp_path / "b", PYTHONHASHSEED="4242", TZ="Asia/Kathmandu", LC_ALL="C.UTF-8")
    assert first == second
