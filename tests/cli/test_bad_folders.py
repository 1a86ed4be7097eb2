"""`cellc mock` on what is no generated folder, or a broken one: the file and the reason, never a traceback."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.refused import assert_refused, everything_below, process
from tests.cli.run import MINIMAL, run

CONTROLLERS = "config/controllers.yaml"
URDF = "urdf/minimal.mock.urdf"


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    output = tmp_path_factory.mktemp("built")
    assert run("build", MINIMAL, "-o", output.as_posix()).code == 0
    return output / "minimal"


@pytest.fixture
def folder(built: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(built, tmp_path / "minimal"))


def test_missing_folder_is_told(tmp_path: Path) -> None:
    ran = run("mock", (tmp_path / "none").as_posix())
    assert_refused(ran, "no such folder; name one that `cellc build` wrote")
    assert ran.code == 2


def test_empty_folder_is_told(tmp_path: Path) -> None:
    assert_refused(run("mock", tmp_path.as_posix()), f"{tmp_path.as_posix()}: holds no contract.json")


def test_spec_in_place_of_a_folder_is_told() -> None:
    assert_refused(run("mock", MINIMAL), f"{MINIMAL}: is not a folder")


def _truncated(file: Path) -> None:
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def _folder_instead(file: Path) -> None:
    file.unlink()
    file.mkdir()


HARM: dict[str, Callable[[Path], object]] = {
    "empty": lambda file: file.write_bytes(b""),
    "binary": lambda file: file.write_bytes(bytes(range(256))),
    "list": lambda file: file.write_bytes(b"[]"),
    "open": lambda file: file.write_bytes(b'{"a": ['),
    "deep": lambda file: file.write_bytes(b"[" * 100_000),
    "truncated": _truncated,
    "missing": lambda file: file.unlink(),
    "folder": _folder_instead,
}


@pytest.mark.parametrize("harm", HARM)
@pytest.mark.parametrize("name", ["contract.json", "rehearsals.json", "manifest.json", CONTROLLERS, URDF])
def test_broken_file_is_named(name: str, harm: str, folder: Path) -> None:
    HARM[harm](folder / name)
    ran = run("mock", folder.as_posix(), "--edited")
    assert_refused(ran, name.rpartition("/")[2])
    assert all(len(line) < 1000 for line in (ran.out + ran.err).splitlines())


@pytest.mark.parametrize(
    ("text", "words"),
    [
        # rcl_yaml_param_parser's own words.
        ("a: &a {ros__parameters: {b: 1}}\nc: *a\n", "Will not support aliasing at line 2"),
        ("a: &a {b: *a}\n", "Will not support aliasing at line 1"),
        ("a:\n\tb: 1\n", "cannot start any token"),
    ],
)
def test_parameter_file_that_rcl_refuses_ends_bringup(text: str, words: str, folder: Path) -> None:
    (folder / CONTROLLERS).write_text(text)
    ran = run("mock", folder.as_posix(), "--edited")
    assert_refused(ran, words)
    assert "bringup_failure" in ran.out


def test_unknown_rehearsal_names_those_that_exist(built: Path) -> None:
    ran = run("mock", built.as_posix(), "--rehearsal", "redy")
    assert_refused(ran, "has no rehearsal `redy`; it has `ready`")
    assert ran.code == 2


def test_negative_seed_is_refused(built: Path) -> None:
    assert_refused(run("mock", built.as_posix(), "--seed", "-1"), "the seed is -1")


@pytest.mark.parametrize("records", ["", "none/records.jsonl"])
def test_records_that_cannot_be_written_are_told(records: str, built: Path, tmp_path: Path) -> None:
    ran = process("mock", str(built), "--records", records, cwd=tmp_path)
    assert_refused(ran, "cannot be written")
    assert everything_below(tmp_path) == []


def test_records_go_into_a_pipe_instead_of_replacing_it(built: Path) -> None:
    ran = process("mock", str(built), "--records", "/dev/stderr")
    assert ran.code == 0
    assert '"attempt_id"' in ran.err
    assert Path("/dev/stderr").is_symlink()
