"""The steps of action.yml, run by bash as GitHub runs them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

from tests.cells import ROOT
from tests.foreign_yaml import safe_load
from tests.pull_request.conftest import environment

ACTION: dict[str, Any] = safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
STEPS: dict[str, dict[str, Any]] = {step["name"]: step for step in ACTION["runs"]["steps"]}
_EXPRESSION = re.compile(r"\$\{\{\s*(.+?)\s*\}\}")


def run_step(
    folder: Path, name: str, runner: Path | None = None, action: Path = ROOT, **given: str
) -> tuple[int, str, str]:
    """Run a step in a checkout; return its exit code, what it printed, and the summary.

    Args:
        runner: the folder of the runner; by default one where the cellc of this interpreter is installed.
    """
    step, known = STEPS[name], {"github.action_path": str(action)}
    for key, facts in ACTION["inputs"].items():
        known[f"inputs.{key}"] = given.get(key.replace("-", "_"), str(facts["default"]))
    values = {key: _EXPRESSION.sub(lambda one: known[one[1]], text) for key, text in step["env"].items()}
    runner = runner or _installed(folder.parent / "runner")
    runner.mkdir(exist_ok=True)
    summary = folder.parent / "summary.md"
    summary.touch()
    # GitHub: `bash --noprofile --norc -eo pipefail {0}`.
    ran = subprocess.run(
        ("bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]),
        cwd=folder,
        env=environment(
            **values,
            GITHUB_STEP_SUMMARY=str(summary),
            GITHUB_OUTPUT=str(folder.parent / "outputs.txt"),
            GITHUB_SERVER_URL="https://github.com",
            GITHUB_REPOSITORY="lab/cells",
            GITHUB_RUN_ID="7",
            RUNNER_TEMP=str(runner),
        ),
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    return ran.returncode, ran.stdout + ran.stderr, summary.read_text(encoding="utf-8")


def _installed(runner: Path) -> Path:
    """Put the interpreter of this process where the first step installs one."""
    python = runner / "cellc/bin/python"
    python.parent.mkdir(parents=True, exist_ok=True)
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n', encoding="utf-8")
    python.chmod(0o755)
    return runner
