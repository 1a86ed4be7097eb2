"""A small repository with one cell of an own robot, generated and committed; each test has a copy of it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import CORPUS, build_into
from tests.cli.run import run

CELL = """format: 1
cell: line
summary: A stage with two joints
versions: {ros: jazzy}
devices:
  stage: {model: ./stage}
control:
  update_rate: 100 Hz
  controllers:
    joint_states: {type: joint_state_broadcaster}
    stage_trajectory: {type: joint_trajectory, device: stage, goal_time: 1 s, path_tolerance: 0.1 rad 10 mm,
                       goal_tolerance: 0.01 rad 1 mm}
rehearsals:
  waits: {steps: [{wait: 1 s}]}
"""


def environment(**more: str) -> dict[str, str]:
    """Return what a shell of the user has: our command first, and git without anybody's settings."""
    nobody = {f"GIT_{role}_{what}": "nobody" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    own = {"PATH": path, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    return {**os.environ, **nobody, **own, **more}


def git(folder: Path, *words: str) -> str:
    """Run git and return what it printed."""
    ran = subprocess.run(
        ("git", *words), cwd=folder, env=environment(), capture_output=True, text=True, check=True, timeout=60
    )
    return ran.stdout


@pytest.fixture(scope="session")
def _committed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pull_request")
    cell = folder / "cells" / "line"
    shutil.copytree(CORPUS / "invalid" / "base" / "stage", cell / "stage")
    (cell / "cell.yaml").write_text(CELL, encoding="utf-8")
    assert run("format", str(folder)).code == 0
    build_into(folder / "generated" / "line", cell / "cell.yaml")
    git(folder, "init", "-q", "-b", "main")
    git(folder, "add", "-A")
    git(folder, "commit", "-q", "-m", "A cell")
    return folder


@pytest.fixture
def repository(_committed: Path, tmp_path: Path) -> Path:
    """A copy that a test may spoil."""
    return Path(shutil.copytree(_committed, tmp_path / "repository"))
