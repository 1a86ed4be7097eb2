"""Nothing of a checkout is executed: not by a step of action.yml, not by a hook, not by a command of README."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.foreign_yaml import safe_load
from tests.pull_request.action import STEPS, run_step
from tests.pull_request.conftest import environment
from tests.pull_request.shadows import shadow

HOOKS: list[dict[str, list[str] | str]] = safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
README = (ROOT / "README.md").read_text(encoding="utf-8")
# What installs cellc runs in its own checkout, which is trusted.
COMMANDS = re.findall(r"^cellc .*", README.partition("## Your own cell")[2].partition("\n## ")[0], re.MULTILINE)
RUN_ELSEWHERE = ("check", "build", "mock")  # by steps of the action, and by hooks
BACKEND = """
import zipfile
def build_wheel(folder, config_settings=None, metadata_directory=None):
    with zipfile.ZipFile(folder + "/cellc-0-py3-none-any.whl", "w") as wheel:
        wheel.writestr("cellc/__main__.py", "print('cellc of the action')")
        wheel.writestr("cellc-0.dist-info/METADATA", "Metadata-Version: 2.1\\nName: cellc\\nVersion: 0\\n")
        wheel.writestr("cellc-0.dist-info/WHEEL", "Wheel-Version: 1.0\\nRoot-Is-Purelib: true\\nTag: py3-none-any\\n")
        wheel.writestr("cellc-0.dist-info/RECORD", "")
    return "cellc-0-py3-none-any.whl"
"""
PROJECT = """[project]
name = "cellc"
version = "0"
[build-system]
requires = []
build-backend = "made"
backend-path = ["."]
"""


@pytest.fixture
def sprung(repository: Path) -> Path:
    """The file that the traps of the checkout write to."""
    file = repository.parent / "sprung"
    shadow(repository, file)
    return file


def _told(sprung: Path) -> str:
    return sprung.read_text(encoding="utf-8") if sprung.exists() else ""


@pytest.mark.parametrize("name", list(STEPS))
def test_no_step_of_the_action_runs_a_file_of_the_branch(name: str, repository: Path, sprung: Path) -> None:
    if name == "Install cellc":
        _installs(repository)
    else:
        code, out, _ = run_step(repository, name, base="HEAD~0", sarif="cellc.sarif")
        assert code == 0, out
    assert _told(sprung) == ""


def _installs(repository: Path) -> None:
    """Install an action that stands for ours: its dependencies come from an index, and are no matter of this test."""
    action = repository.parent / "action"
    (action / ".ci").mkdir(parents=True)
    (action / ".ci/requirements.txt").touch()
    (action / "made.py").write_text(BACKEND, encoding="utf-8")
    (action / "pyproject.toml").write_text(PROJECT, encoding="utf-8")
    runner = repository.parent / "empty"
    code, out, _ = run_step(repository, "Install cellc", runner=runner, action=action)
    assert code == 0, out
    python = runner / "cellc/bin/python"
    ran = subprocess.run((python, "-I", "-m", "cellc"), cwd=repository, capture_output=True, text=True, check=True)
    assert ran.stdout == "cellc of the action\n"


@pytest.mark.parametrize("hook", HOOKS, ids=lambda hook: str(hook["id"]))
def test_no_hook_runs_a_file_of_the_branch(hook: dict[str, list[str] | str], repository: Path, sprung: Path) -> None:
    _run(repository, [*shlex.split(str(hook["entry"])), *hook["args"]])
    assert _told(sprung) == ""


def test_no_command_of_readme_runs_a_file_of_the_folder(repository: Path, sprung: Path) -> None:
    for command in COMMANDS:
        words = shlex.split(command, comments=True)
        if words[1] not in RUN_ELSEWHERE:
            _run(repository, words)
    assert (repository / "cells/bench/cell.yaml").exists()
    assert _told(sprung) == ""


def _run(folder: Path, words: list[str]) -> None:
    program = Path(sys.executable).parent / words[0]  # by its path: an empty word of PATH is the user's own matter
    ran = subprocess.run(
        [program, *words[1:]], cwd=folder, env=environment(), capture_output=True, text=True, check=False, timeout=120
    )
    assert ran.returncode in (0, 1, 2), ran.stdout + ran.stderr
    assert "Traceback" not in ran.stderr


def test_traps_spring_where_they_are_not_avoided(repository: Path, sprung: Path) -> None:
    subprocess.run((sys.executable, "-m", "venv", "absent"), cwd=repository, capture_output=True, check=False)
    assert _told(sprung)
    sprung.unlink()
    subprocess.run(("git", "status"), cwd=repository, env=environment(), capture_output=True, check=False)
    assert _told(sprung)
