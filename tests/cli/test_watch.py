"""``cellc watch``: what counts as a change, and what is answered."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from cellc.cli.watch import Watched, different
from tests.cells import CORPUS, ROOT
from tests.cli.run import run

_CELL = """\
format: 1
cell: line
include: parts/hosts.yaml
versions: {ros: jazzy}
devices:
  stage: {model: ./stage}
control:
  update_rate: 100 Hz
  controllers:
    joint_states: {type: joint_state_broadcaster}
"""


@pytest.fixture
def cells(tmp_path: Path) -> Path:
    """Two cells of one repository, whose generated folder lies beside them."""
    for name in ("one", "two"):
        folder = tmp_path / "cells" / name
        shutil.copytree(CORPUS / "invalid/base/stage", folder / "stage")
        (folder / "parts").mkdir()
        (folder / "parts" / "hosts.yaml").write_text("hosts:\n  pc: {scheduling: generic}\n")
        (folder / "cell.yaml").write_text(_CELL.replace("line", name))
    return tmp_path


@pytest.fixture(autouse=True)
def _no_wait_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """A change that is not seen is waited for by nobody."""
    turns = iter(range(50))

    def sleep(seconds: float) -> None:
        assert seconds > 0
        assert next(turns, None) is not None, "no change is seen"

    monkeypatch.setattr(time, "sleep", sleep)


def _touch(file: Path) -> None:
    file.parent.mkdir(exist_ok=True, parents=True)
    file.write_text(f"{file.read_text() if file.exists() else ''}# again\n")


@pytest.mark.parametrize("file", ["cell.yaml", "parts/hosts.yaml", "stage/device.yaml", "stage/stage.urdf", "new.stl"])
def test_files_of_a_cell_count_and_are_of_that_cell_alone(cells: Path, file: str) -> None:
    watched = Watched([str(cells)], cells / "generated")
    before = watched.look()
    _touch(cells / "cells/one" / file)
    after, changed = watched.next_change(before)
    assert changed == (str(cells / "cells/one/cell.yaml"),)
    assert different(before, after) == {str(cells / "cells/one" / file)}


@pytest.mark.parametrize("file", ["generated/one/x.yaml", ".git/index", "venv/lib/x.py", "elsewhere/pkg/contract.json"])
def test_what_is_generated_or_hidden_does_not_count(cells: Path, file: str) -> None:
    _touch(cells / "venv" / "pyvenv.cfg")
    _touch(cells / "elsewhere" / "pkg" / "manifest.json")
    watched = Watched([str(cells)], cells / "generated")
    before = watched.look()
    _touch(cells / file)
    assert watched.look() == before


def test_packages_that_a_cell_names_count(cells: Path) -> None:
    spec = str(cells / "cells/one/cell.yaml")
    watched = Watched([spec], cells / "generated")
    watched.packages[spec] = (str(cells / "cells/one/../../shared"),)
    _touch(cells / "shared/meshes/a.stl")
    before = watched.look()
    _touch(cells / "shared/meshes/a.stl")
    assert watched.next_change(before)[1] == (spec,)


def test_file_that_goes_and_cell_that_comes_are_changes(cells: Path) -> None:
    watched = Watched([str(cells)], cells / "generated")
    before = watched.look()
    (cells / "cells/two/parts/hosts.yaml").unlink()
    before, changed = watched.next_change(before)
    assert changed == (str(cells / "cells/two/cell.yaml"),)
    (cells / "cells/three").mkdir()
    (cells / "cells/three/cell.yaml").write_text(_CELL)
    assert watched.next_change(before)[1] == (str(cells / "cells/three/cell.yaml"),)


def test_cell_is_built_once_no_error_is_left(cells: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def end(watched: Watched, before: object) -> None:
        raise SystemExit(0)

    monkeypatch.setattr(Watched, "next_change", end)
    ran = run("watch", str(cells / "cells/one"), "--build", "-o", str(cells / "generated"))
    assert f"{(cells / 'generated/one').as_posix()}: " in ran.out
    assert (cells / "generated/one/package.xml").is_file()


def test_save_is_answered_until_ctrl_c(cells: Path) -> None:
    spec = cells / "cells/one/cell.yaml"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        [sys.executable, "-m", "cellc", "watch", str(spec)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    ) as process:
        too_late = threading.Timer(60, process.kill)
        too_late.start()
        assert process.stderr is not None
        assert process.stderr.readline() == "watching 1 cell; Ctrl-C ends it\n"
        spec.write_text(spec.read_text().replace("update_rate", "upate_rate"))
        assert process.stderr.readline() == "watching 1 cell; Ctrl-C ends it\n"
        process.send_signal(signal.SIGINT)
        out, err = process.communicate()
        too_late.cancel()
    assert process.returncode == 130
    assert err == "error: interrupted; nothing was left half-written\n"
    before, told = out.split("error[unknown-key]", 1)
    assert f"in {spec.as_posix()}" in before
    assert "did you mean `update_rate`?" in told
    assert "\x1b" not in out, "a screen is cleared on a terminal alone"
