"""Runs a page as a reader would: its edits are made, its commands run, and their output stands below each.

After a message has changed, `python -m tests.docs.tutorial` writes what is printed now into the pages.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.cli.run import run as run_command

PAGE = ROOT / "docs" / "tutorial.md"
_BLOCK = re.compile(r"```(console|diff)\n(.*?)```", re.DOTALL)
_TIMES = re.compile(r"in \d+\.\d+ s( \(\d+ x real time\))?")
OWN_ROBOT = ROOT / "docs" / "own_robot.md"
_ROBOT = ROOT / "tests/corpus/valid/parts/lift/lift.urdf"


def rerun(page: str, folder: Path) -> str:
    """Return the page with the output that its commands print in a folder; a measured time is left as it was."""

    def run(match: re.Match[str]) -> str:
        kind, text = match.groups()
        if kind == "diff":
            _edit(folder, text)
            return match[0]
        commands = [line for line in text.splitlines() if line.startswith("$ ")]
        printed = "".join(f"{command}\n{_output(command[2:], folder)}" for command in commands)
        same = _TIMES.sub("", printed) == _TIMES.sub("", text)
        return match[0] if same else f"```console\n{printed}```"

    return _BLOCK.sub(run, page)


def _edit(folder: Path, diff: str) -> None:
    """Make an edit: what is unchanged or taken out must stand in the file once."""
    head, *lines = diff.splitlines(keepends=True)
    file = folder / head.removeprefix("--- ").strip()
    before = "".join(line[1:] for line in lines if line[0] in " -")
    after = "".join(line[1:] for line in lines if line[0] in " +")
    text = file.read_text(encoding="utf-8")
    assert text.count(before) == 1, f"{before!r} stands {text.count(before)} times in {file.name}"
    file.write_text(text.replace(before, after), encoding="utf-8")


def _output(command: str, folder: Path) -> str:
    """Return what a command prints: `cellc` is run in this process, what its output is piped through by a shell."""
    program, pipe, rest = command.partition(" | ")
    if not program.startswith("cellc "):
        return _shell(command, folder, "")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        ran = run_command(*shlex.split(program)[1:])
    return _shell(rest, folder, ran.out) + ran.err if pipe else ran.out + ran.err


def _shell(command: str, folder: Path, text: str) -> str:
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=os.environ | {"LC_ALL": "C.UTF-8"},
        input=text,
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout + done.stderr


def rerun_page(page: Path, folder: Path) -> str:
    """Return a page with the output that its commands print, in a folder that has the reader's robot."""
    shutil.copy(_ROBOT, folder / "my_arm.urdf")
    return rerun(page.read_text(encoding="utf-8"), folder)


if __name__ == "__main__":
    for shown in (PAGE, OWN_ROBOT):
        with tempfile.TemporaryDirectory() as place:
            shown.write_text(rerun_page(shown, Path(place)), encoding="utf-8")
