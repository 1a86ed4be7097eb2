"""What people name by mistake, given to each command that takes a path: an exit code and one line that is right."""

from __future__ import annotations

import io
import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest

from cellc.tools.cli.main import cellc
from tests.attempt.hand_made import arrived
from tests.cells import ROOT
from tests.cli.run import run

INPUTS = (
    "emptyfolder",
    "missing/path",
    "junk.txt",
    "-",
    "binary.bin",
    "arm/device.yaml",
    "built",
    "robot.urdf",
    "cell",
)
NO_FILE = "there is no file `{}`"
FOLDER = "`{}` is a folder"
TEXT = "the root of `{}` is a single value, not a mapping of sections"
BYTES = "not UTF-8"
DEVICE = "`{}` is a device, not a cell"
ROBOT = "this looks like XML/URDF, not a cell spec"
NOT_BUILT = "holds no contract.json; name a folder that `cellc build` wrote"
NO_FOLDER = "is not a folder; name one that `cellc build` wrote"
NOT_GENERATED = "{} has no `manifest.json`: it is not a generated folder"
NO_GIT = "is not in a readable Git repository"
NOTHING = "there is no file or folder `{}`"
NO_BAG = "holds no file .mcap or .db3"
NO_LOG = "no such file or folder"
NO_BAG_FILE = "must be a folder of rosbag2, or a file .mcap or .db3"
XML = "not well-formed XML"
NO_SOURCE = "refused: `{}` is not a file, a folder or an installed package"

NOTHING_DRAWN = "the folder has no `config/uncertainty.json`"


def _of_a_folder(code: int, said: str) -> tuple[tuple[int, str], ...]:
    """Return what a command of the mock answers, which has this to say of a generated folder."""
    none = "no such folder; name one that `cellc build` wrote"
    no_folder = (2, NO_FOLDER)
    return (
        (2, NOT_BUILT),
        (2, none),
        no_folder,
        (2, none),
        no_folder,
        no_folder,
        (code, said),
        no_folder,
        (2, NOT_BUILT),
    )


_SPEC = ((1, FOLDER), (1, NO_FILE), (1, TEXT), (1, NO_FILE), (1, BYTES), (1, DEVICE), (1, FOLDER), (1, ROBOT))
ROWS: dict[str, tuple[tuple[int, str], ...]] = {
    "attempt {} --package built": (
        (2, NO_BAG),
        (2, "no such file or folder"),
        (2, NO_BAG_FILE),
        (2, "no such file or folder"),
        (2, NO_BAG_FILE),
        (2, NO_BAG_FILE),
        (2, NO_BAG),
        (2, NO_BAG_FILE),
        (2, NO_BAG),
    ),
    "attempt good --package {}": (
        (2, NOT_BUILT),
        (2, "no such folder"),
        (2, NO_FOLDER),
        (2, "no such folder"),
        (2, NO_FOLDER),
        (2, NO_FOLDER),
        (0, "outcome  succeeded"),
        (2, NO_FOLDER),
        (2, NOT_BUILT),
    ),
    "attempt good --package picked --against {}": (
        (2, NO_BAG),
        (2, "`{}` must be a bag, a file of records or a rehearsal of the package; it has `pick_and_place`"),
        (2, NO_BAG_FILE),
        (2, "`{}` must be a bag, a file of records or a rehearsal of the package; it has `pick_and_place`"),
        (2, NO_BAG_FILE),
        (2, NO_BAG_FILE),
        (2, NO_BAG),
        (2, NO_BAG_FILE),
        (2, NO_BAG),
    ),
    "audit {}": (*_SPEC, (1, FOLDER)),
    "build {} -o out": (*_SPEC, (0, "written")),
    # A device and a robot are judged for themselves.
    "check {}": (*_SPEC[:5], (-1, ""), _SPEC[6], (0, "no findings in {}"), (0, "in cell/cell.yaml")),
    "compare {} cell/cell.yaml": (*_SPEC, (1, FOLDER)),
    # What is no file is a word of the symptom.
    "diagnose does not move {}": tuple(
        (code, said) if said in (TEXT, BYTES, DEVICE, ROBOT) else (0, "does not take commands")
        for code, said in (*_SPEC, (1, FOLDER))
    ),
    "diagnose --log {}": (
        (2, "holds no log that can be read; it is empty"),
        (2, NO_LOG),
        (0, "no known symptom in 1 line of 1 file"),
        (2, NO_LOG),
        (0, "no known symptom in 21 lines of 1 file"),
        (0, "no known symptom in 22 lines of 1 file"),
        (1, "first layer, not sure: owner of the command"),  # its pages name what fails
        (0, "no known symptom"),
        (0, "no known symptom"),
    ),
    "diff {} cell/cell.yaml": (
        (2, NOT_GENERATED),
        (2, NOTHING),
        (2, TEXT),
        (2, NO_GIT),
        (2, BYTES),
        (2, DEVICE),
        (0, "no change"),
        (2, ROBOT),
        (2, NOT_GENERATED),
    ),
    "evidence {} --package built": (
        (1, "14 gates: 0 complete, 0 FAILED, 14 UNKNOWN"),
        (2, "no such folder"),
        (2, "is not a folder"),
        (2, "no such folder"),
        (2, "is not a folder"),
        (2, "is not a folder"),
        (1, "0 complete, 0 FAILED"),
        (2, "is not a folder"),
        (1, "0 complete, 0 FAILED"),
    ),
    "evidence emptyfolder --package {}": (
        (2, NOT_BUILT),
        (2, "no such folder"),
        (2, NO_FOLDER),
        (2, "no such folder"),
        (2, NO_FOLDER),
        (2, NO_FOLDER),
        (1, "0 complete, 0 FAILED"),
        (2, NO_FOLDER),
        (2, NOT_BUILT),
    ),
    "format {} --check": (
        (2, "there is no cell.yaml, device.yaml or *.family.yaml below `{}`"),
        (1, NO_FILE),
        (1, TEXT),
        (1, "the list in brackets is not closed"),
        (1, BYTES),
        (-1, ""),
        (2, "below `{}`"),
        (1, "this looks like XML/URDF"),
        (0, "1 file is in canonical form"),
    ),
    "hook {} -o out --fix": (
        (2, "there is no cell.yaml, device.yaml or *.family.yaml below `{}`"),
        (1, NO_FILE),
        (1, TEXT),
        (1, NO_FILE),
        (1, BYTES),
        (1, DEVICE),
        (2, "below `{}`"),
        (1, ROBOT),
        (0, "1 cell up to date"),
    ),
    "import {} -o made": (
        (1, "refused: `{}` holds no URDF or xacro file"),
        (1, NO_SOURCE),
        (1, XML),
        (1, NO_SOURCE),
        (1, BYTES),
        (1, XML),
        (1, "refused: `{}` holds 2 descriptions, name one"),
        (0, "wrote made"),
        (1, "refused: `{}` holds no URDF or xacro file"),
    ),
    "mock {}": _of_a_folder(0, "passed  ready"),
    "campaign {} --list": _of_a_folder(0, "ready/skip_cycles@1"),
    "sweep {}": _of_a_folder(2, NOTHING_DRAWN),
    "replay {} skip_cycles@1": _of_a_folder(0, "passed  ready/skip_cycles@1"),
    "gates {} --sweep 9": _of_a_folder(2, NOTHING_DRAWN),
    "show {}": (*_SPEC, (1, FOLDER)),
    "upgrade {} --ros jazzy": tuple((2, said) for _, said in (*_SPEC, (1, FOLDER))),
    "view picked --bag {} -o page.html": (
        (2, NO_BAG),
        (2, "no such file or folder"),
        (2, NO_BAG_FILE),
        (2, "no such file or folder"),
        (2, NO_BAG_FILE),
        (2, NO_BAG_FILE),
        (2, NO_BAG),
        (2, NO_BAG_FILE),
        (2, NO_BAG),
    ),
    "view {} --bag good -o page.html": (
        (2, NOT_BUILT),
        (2, "there is no such file or folder"),
        (2, "a bag needs the package of its cell"),
        (2, "there is no such file or folder"),
        (2, "a bag needs the package of its cell"),
        (2, DEVICE),
        (0, "wrote page.html"),
        (2, "a bag needs the package of its cell"),
        (0, "wrote page.html"),
    ),
    "view picked --bag good --against {} -o page.html": (
        (2, NO_BAG),
        (2, "`{}` must be a bag, a file of records or a rehearsal of the package; it has `pick_and_place`"),
        (2, NO_BAG_FILE),
        (2, "`{}` must be a bag, a file of records or a rehearsal of the package; it has `pick_and_place`"),
        (2, NO_BAG_FILE),
        (2, NO_BAG_FILE),
        (2, NO_BAG),
        (2, NO_BAG_FILE),
        (2, NO_BAG),
    ),
    "view {} -o page.html": (
        (2, NOT_BUILT),
        (2, "there is no such file or folder"),
        (1, TEXT),
        (2, "there is no such file or folder"),
        (1, BYTES),
        (2, DEVICE),
        (0, "wrote page.html"),
        (0, "wrote page.html"),
        (0, "wrote page.html"),
    ),
}
"""For each command an exit code, -1 where any is right, and a text of one line, for each of the inputs."""
WAITS = {"watch": "it waits for a file to be saved, and refuses what is not there"}


@pytest.fixture(scope="module", name="folder")
def folder_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("inputs")
    (folder / "emptyfolder").mkdir()
    (folder / "junk.txt").write_text("some words, nothing else\n")
    (folder / "binary.bin").write_bytes(bytes(range(255, 0, -1)) * 20)
    shutil.copytree(ROOT / "tests/corpus/valid/parts/lift", folder / "arm")
    shutil.copy(ROOT / "tests/corpus/valid/parts/lift/lift.urdf", folder / "robot.urdf")
    shutil.copytree(ROOT / "generated/minimal", folder / "built")
    shutil.copytree(ROOT / "generated/ur5e_pick", folder / "picked")
    shutil.copytree(ROOT / "cells/minimal", folder / "cell")
    arrived().write(folder / "good")
    return folder


def _cases() -> Iterator[tuple[str, str, int, str]]:
    for call, answers in ROWS.items():
        for given, (code, said) in zip(INPUTS, answers, strict=True):
            yield call, given, code, said


@pytest.mark.parametrize(("call", "given", "code", "said"), list(_cases()))
def test_what_is_named_by_mistake_is_told_in_one_line(
    call: str, given: str, code: int, said: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", os.fspath(folder.parent))
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"one: [two\n")))
    shutil.rmtree(folder / "made", ignore_errors=True)
    ran = run(*call.format(given).split())
    told = ran.out + ran.err
    assert ran.code in ((0, 1, 2) if code < 0 else (code,)), told
    assert said.format(given) in told
    assert "Traceback" not in told
    assert "bug of cellc" not in told
    if ran.code == 1 and "error[" in told and given != "arm/device.yaml":
        assert told.count("error[") == 1, told


WRITTEN = {"--output", "--sarif", "--records", "--evidence", "--film"}
"""Options that name what is written: test_bad_outputs.py."""
NAMED = {"import --srdf", "import --controllers", "sweep --journal", "replay --journal", "gates --journal"}
"""Options whose files belong to a run, or to a robot: their own tests."""


def test_every_option_that_names_a_path_to_read_stands_in_the_table() -> None:
    context = click.Context(cellc)
    for name in cellc.list_commands(context):
        command = cellc.get_command(context, name)
        assert command is not None
        for option in (each for each in command.params if isinstance(each, click.Option)):
            call = f"{name} {option.opts[-1]}"
            if isinstance(option.type, click.Path) and option.opts[-1] not in WRITTEN and call not in NAMED:
                assert any(row.startswith(f"{name} ") and f"{option.opts[-1]} {{}}" in row for row in ROWS), call


def test_every_command_that_takes_a_path_stands_in_the_table() -> None:
    context = click.Context(cellc)
    for name in cellc.list_commands(context):
        command = cellc.get_command(context, name)
        assert command is not None
        takes = [p.name for p in command.params if isinstance(p, click.Argument) and isinstance(p.type, click.Path)]
        if takes:
            assert name in {*(call.split()[0] for call in ROWS), *WAITS}, name


@pytest.mark.parametrize("given", ["missing/path", "-"])
def test_watch_refuses_what_is_not_there(given: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    ran = run("watch", given)
    assert ran.code == 2
    assert NOTHING.format(given) in ran.err


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (("robot", "does", "not", "move"), 0, "does not take commands"),
        (("robot does not move",), 0, "does not take commands"),
        (("robot does not move", "cells/minimal/cell.yaml"), 0, "/controller_manager"),
        (("robot", "does", "not", "move", "cells/minimal/cell.yaml"), 0, "/controller_manager"),
        (("cells/minimal/cell.yaml",), 2, "expected a symptom before `cells/minimal/cell.yaml`"),
        (("robot", "nothing.yaml"), 1, "there is no file `nothing.yaml`"),
    ],
)
def test_symptom_needs_no_quotes(words: tuple[str, ...], code: int, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    ran = run("diagnose", *words)
    assert ran.code == code
    assert said in ran.out + ran.err
