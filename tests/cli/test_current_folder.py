"""The current folder may be a checkout of strangers: nothing in it is imported."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PLANTED = ("click", "yaml", "argparse", "multiprocessing", "pydantic")


@pytest.fixture(name="checkout")
def checkout_fixture(tmp_path: Path) -> Path:
    for name in PLANTED:
        (tmp_path / f"{name}.py").write_text("raise SystemExit('the stranger runs')\n", encoding="utf-8")
    return tmp_path


def _run(checkout: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    program = [sys.executable, "-m", *arguments]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONSAFEPATH"}
    return subprocess.run(program, cwd=checkout, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("arguments", "status"), [(("cellc", "--version"), 0), (("cellc.mock", "absent"), 2)], ids=["cellc", "mock"]
)
def test_module_in_the_current_folder_is_not_imported(arguments: tuple[str, ...], status: int, checkout: Path) -> None:
    ended = _run(checkout, *arguments)
    assert "the stranger runs" not in ended.stdout + ended.stderr
    assert ended.returncode == status, ended.stderr


def test_nor_do_the_processes_of_many_cells_import_it(checkout: Path) -> None:
    files = [checkout / f"{number}.yaml" for number in range(32)]
    for file in files:
        file.write_text("format: 1\n", encoding="utf-8")
    ended = _run(checkout, "cellc", "check", *(file.name for file in files))
    assert "the stranger runs" not in ended.stdout + ended.stderr
    assert ended.returncode == 1, ended.stderr
