"""Cells of `cellc init` in an empty folder, and the mistakes that a newcomer makes first."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.cli.refused import process
from tests.cli.run import PICK, Ran, run

INIT = ("init", "bench", "arm=ur5e", "gripper=robotiq_2f_85")


def _ran(folder: Path, line: str) -> Ran:
    ran = process(*line.split(), cwd=folder)
    assert ran.code == 0, ran.out + ran.err
    return ran


@pytest.fixture(name="empty")
def empty_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _ran_here(line: str) -> str:
    """Run a command in this process: what a process of its own adds, other tests hold."""
    ran = run(*line.split())
    assert ran.code == 0, ran.out + ran.err
    return ran.out


@pytest.mark.parametrize("ros", ["humble", "jazzy", "kilted", "lyrical"])
@pytest.mark.usefixtures("empty")
def test_cell_of_init_passes_on_every_distribution(ros: str) -> None:
    _ran_here(f"{' '.join(INIT)} --ros {ros}")
    _ran_here("build cells/bench/cell.yaml")
    assert "passed  ready" in _ran_here("mock generated/bench")


@pytest.mark.parametrize("models", ["ur5e", "robotiq_2f_85", "realsense_d435i", "ur5e ur5e robotiq_2f_85"])
@pytest.mark.usefixtures("empty")
def test_cell_of_init_builds_and_runs_with_any_devices(models: str) -> None:
    _ran_here(f"init bench {models}")
    _ran_here("build cells/bench/cell.yaml")
    _ran_here("mock generated/bench")


def test_cell_of_init_moves_an_imported_robot_with_a_gripper_of_the_catalog(empty: Path) -> None:
    # tests/corpus/valid/parts/lift: a rail and a swing, so metres and radians in one group.
    _ran_here(f"import {ROOT / 'tests/corpus/valid/parts/lift/lift.urdf'} -o my_robot")
    _ran_here("init bench arm=./my_robot gripper=robotiq_2f_85")
    text = (empty / "cell.yaml").read_text(encoding="utf-8")
    assert "model: ./my_robot" in text
    assert "arm_group: 0.05 m 0 0 rad" in text
    _ran_here("build cell.yaml")
    assert "passed  ready: succeeded" in _ran_here("mock generated/bench")


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        ("arm=./nothing", 2, "`nothing` holds no `device.yaml`: `cellc import` writes such a folder"),
        ("arm=./empty_one -o sub/cell.yaml", 2, "`empty_one` must lie below the folder of the spec, which is `sub`"),
        ("arm=./empty_one", 1, "error[catalog-entry-invalid]: `model` is missing"),
    ],
)
def test_folder_that_is_no_device_is_refused_by_init(arguments: str, code: int, said: str, empty: Path) -> None:
    (empty / "empty_one").mkdir()
    (empty / "empty_one/device.yaml").write_text("format: 1\n")
    ran = run(*f"init bench {arguments}".split())
    assert ran.code == code
    assert said in ran.out + ran.err
    assert not (empty / "cell.yaml").exists()


def test_init_tells_the_next_step_and_the_editor_finds_the_schema(tmp_path: Path) -> None:
    told = _ran(tmp_path, f"{' '.join(INIT)} -o deep/er/bench.yaml").out
    assert "next: cellc build deep/er/bench.yaml && cellc mock generated/bench" in told
    assert "cellc schema -o schemas" in told
    _ran(tmp_path, "schema -o schemas")
    modeline = (tmp_path / "deep/er/bench.yaml").read_text().splitlines()[0]
    schema = modeline.removeprefix("# yaml-language-server: $schema=")
    assert (tmp_path / "deep/er" / schema).resolve() == (tmp_path / "schemas/cell.schema.json").resolve()


def test_build_writes_the_same_bytes_from_any_folder(pick: Path, tmp_path: Path) -> None:
    """Only the remembered command names the spec as it was given, so the spec is given alike."""
    far = tmp_path / "far away"
    far.mkdir()
    ran = process("build", PICK, "-o", "here", cwd=far)
    assert ran.code == 0
    built, again = _contents(pick), _contents(far / "here/ur5e_pick")
    assert built == again


def test_edited_file_is_kept_and_named_until_it_is_forced(empty: Path) -> None:
    _ran_here(" ".join(INIT))
    _ran_here("build cells/bench/cell.yaml")
    file = empty / "generated/bench/config/controllers.yaml"
    file.write_text(file.read_text() + "# mine\n")
    (empty / "generated/bench/notes.md").write_text("mine")
    for arguments in (("build",), ("build", "--check")):
        ran = run(*arguments, "cells/bench/cell.yaml")
        assert ran.code == 1
        assert "generated/bench/config/controllers.yaml" in ran.out
    assert file.read_text().endswith("# mine\n")
    _ran_here("build --force cells/bench/cell.yaml")
    assert "# mine" not in file.read_text()
    assert (empty / "generated/bench/notes.md").read_text() == "mine"
    assert "up to date" in _ran_here("build --check cells/bench/cell.yaml")


def _contents(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
