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

from cellc.tools.cli.watch import Watched, different
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


@pytest.mark.parametrize(
    "file", ["log.txt", "notes.yaml", "parts/old.yaml", "bag/metadata.yaml", "shared/x/values.yaml"]
)
def test_what_no_cell_reads_does_not_count(cells: Path, file: str) -> None:
    watched = Watched([str(cells)], cells / "generated")
    spec = str(cells / "cells/one/cell.yaml")
    watched.packages[spec] = (str(cells / "shared"),)
    before = watched.look()
    _touch(cells / "cells/one" / file)
    _touch(cells / file)
    assert watched.look() == before


def test_what_a_cell_names_counts_before_it_is_there_and_as_soon_as_it_is_named(cells: Path) -> None:
    spec = cells / "cells/one/cell.yaml"
    named = "include: [parts/hosts.yaml, parts/more.yaml]\ncalibrations: {hand_eye: {from: measured/eye.json}}"
    spec.write_text(_CELL.replace("line", "one").replace("include: parts/hosts.yaml", named))
    watched = Watched([str(cells)], cells / "generated")
    before = watched.look()
    for file in (
        "parts/more.yaml",
        "measured/eye.json",
        "src/arm_description/package.xml",
        "src/arm_description/a.yaml",
    ):
        _touch(spec.parent / file)
        before, changed = watched.next_change(before)
        assert changed == (str(spec),), file
    spec.write_text(spec.read_text().replace("parts/more.yaml", "parts/other.yaml"))
    before, changed = watched.next_change(before)
    watched.learn(str(spec))
    before = {**watched.look(), **before}
    _touch(spec.parent / "parts/more.yaml")
    (spec.parent / "parts/other.yaml").write_text("kpis: {cancel: 1 s}\n")
    assert watched.next_change(before)[1] == (str(spec),)
    watched.learn(str(spec))
    assert str(spec.parent / "parts/more.yaml") not in watched.look()


def test_an_error_of_yaml_does_not_hide_what_the_cell_read_before(cells: Path) -> None:
    spec = cells / "cells/one/cell.yaml"
    watched = Watched([str(spec)], cells / "generated")
    before = watched.look()
    spec.write_text("cell: [\n")
    before, _ = watched.next_change(before)
    watched.learn(str(spec))
    _touch(spec.parent / "stage/device.yaml")
    assert watched.next_change(before)[1] == (str(spec),)


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
    before, changed = watched.next_change(before)
    assert changed == (str(cells / "cells/three/cell.yaml"),)
    (cells / "cells/three/cell.yaml").unlink()
    assert watched.next_change(before)[1] == (), "nothing is left to be checked, and the number of cells is another"


@pytest.mark.parametrize("paths", [("nofile",), ("cell.yaml", "nofolder/cell.yaml"), ("none/*/cell.yaml",)])
def test_a_path_that_is_not_there_is_not_waited_for(
    paths: tuple[str, ...], cells: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(cells / "cells/one")
    ran = run("watch", *paths)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.endswith(f"\nError: there is no file or folder `{paths[-1]}`.\n")


def test_a_folder_without_a_cell_is_told_and_waited_for(cells: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def come(watched: Watched, before: object) -> None:
        raise SystemExit(0)

    monkeypatch.setattr(Watched, "next_change", come)
    (cells / "empty").mkdir()
    monkeypatch.chdir(cells)
    ran = run("watch", "empty")
    assert ran.out == "there is no cell.yaml below `empty` yet\n"
    assert ran.err == "watching 0 cells; Ctrl-C ends it\n"


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
