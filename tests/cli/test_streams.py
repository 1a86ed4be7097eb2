"""Where the output goes: closed, full, cut off by `head`, coloured or not, and for programs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.cli.refused import process
from tests.cli.run import MINIMAL, PICK, run

_COMMANDS = ["check cells/minimal/cell.yaml", "explain --all", "schema", "show cells/minimal/cell.yaml devices"]
_FULL = Path("/dev/full")


def _shell(command: str, redirection: str) -> tuple[int, str]:
    script = f'set -o pipefail; "{sys.executable}" -m cellc {command} {redirection}'
    done = subprocess.run(["bash", "-c", script], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False)
    return done.returncode, done.stderr


@pytest.mark.parametrize("command", _COMMANDS)
def test_reader_that_has_seen_enough_ends_the_command_silently(command: str) -> None:
    code, told = _shell(command, "| head -n 1")
    assert code in (0, 1, 141)  # the last where the command had more to say
    assert told == ""


@pytest.mark.skipif(not _FULL.is_char_device(), reason="this system has no /dev/full")
@pytest.mark.parametrize("command", _COMMANDS[::2])
def test_full_disk_under_the_output_is_one_line(command: str) -> None:
    assert _shell(command, "> /dev/full") == (70, "error: no space left on device\n")


@pytest.mark.parametrize("command", _COMMANDS[1::2])
def test_closed_output_does_not_matter(command: str) -> None:
    assert _shell(command, ">&- 2>&-") == (0, "")


def test_colour_is_for_terminals_and_can_be_forced_and_refused() -> None:
    assert "\x1b[" not in process("check", MINIMAL).out
    assert "\x1b[" in process("check", MINIMAL, FORCE_COLOR="1").out
    assert "\x1b[" not in process("check", MINIMAL, FORCE_COLOR="1", NO_COLOR="1").out


@pytest.mark.parametrize("output_format", ["json", "sarif"])
@pytest.mark.parametrize("command", ["check", "build"])
def test_output_for_programs_is_json_alone_even_for_errors(command: str, output_format: str, tmp_path: Path) -> None:
    (tmp_path / "empty.yaml").touch()
    for file in (PICK, MINIMAL, (tmp_path / "empty.yaml").as_posix()):
        output = ("-o", (tmp_path / "out").as_posix()) if command == "build" else ()
        assert json.loads(run(command, file, "--format", output_format, *output).out)


def test_characters_that_the_terminal_lacks_are_escaped(tmp_path: Path) -> None:
    folder = tmp_path / "a 机"
    folder.mkdir()
    file = folder / "zelle.yaml"
    file.write_text("cell: 机\n", encoding="utf-8")
    ran = process("check", str(file), PYTHONIOENCODING="latin-1")
    assert ran.code == 1
    assert "a \\u673a/zelle.yaml" in ran.out
    assert "Traceback" not in ran.err


@pytest.mark.parametrize("command", ["", "audit", "build", "check", "completion", "explain", "init", "mock", "schema"])
def test_help_is_told_without_work(command: str) -> None:
    ran = run(*command.split(), "--help")
    assert ran.code == 0
    assert ran.out.startswith("Usage: cellc")
    assert all(len(line) <= 80 for line in ran.out.splitlines())


def test_version_is_told() -> None:
    from cellc import __version__

    assert __version__ in run("--version").out


def test_spec_is_checked_from_another_folder_with_spaces_in_its_path(tmp_path: Path) -> None:
    folder = tmp_path / "my cells ü"
    folder.mkdir()
    (folder / "cell.yaml").write_bytes(Path(MINIMAL).read_bytes())
    absolute = process("check", str(folder / "cell.yaml"), cwd=tmp_path)
    relative = process("check", f"my cells ü{os.sep}cell.yaml", cwd=tmp_path)
    assert absolute.code == relative.code == 0
    assert "--> my cells ü/cell.yaml:3:7" in relative.out
