"""``cellc format``: what is written, told and refused."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

from tests.cli.run import Ran, run

_UGLY = "cell:   x  # the name\nformat: 1\n"
_FORM = "format: 1\ncell: x    # the name\n"


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    file = tmp_path / "cell.yaml"
    file.write_text(_UGLY)
    return file


def _piped(monkeypatch: pytest.MonkeyPatch, content: str, *options: str) -> Ran:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(content.encode())))
    return run("format", "-", *options)


def test_file_is_put_into_its_form_and_told(spec: Path) -> None:
    ran = run("format", str(spec))
    assert (ran.code, ran.out, ran.err) == (0, "", f"formatted {spec.as_posix()}\n")
    assert spec.read_text() == _FORM
    assert run("format", str(spec)).err == "1 file is in canonical form\n"


def test_check_fails_and_writes_nothing(spec: Path) -> None:
    ran = run("format", "--check", str(spec))
    assert (ran.code, ran.err) == (1, f"would format {spec.as_posix()}\n")
    assert spec.read_text() == _UGLY
    spec.write_text(_FORM)
    assert run("format", "--check", str(spec)).code == 0


def test_difference_is_shown_and_nothing_written(spec: Path) -> None:
    ran = run("format", "--diff", str(spec))
    assert ran.code == 0
    assert ran.out.split("\n")[2:] == [
        "@@ -1,3 +1,3 @@",
        "-cell:   x  # the name",
        " format: 1",
        "+cell: x    # the name",
        " ",
        "",
    ]
    assert spec.read_text() == _UGLY


def test_a_folder_without_anything_to_format_is_told_as_such(tmp_path: Path) -> None:
    ran = run("format", str(tmp_path))
    assert (ran.code, ran.out) == (2, "")
    assert f"there is no cell.yaml, device.yaml or *.family.yaml below `{tmp_path}`" in ran.err


def test_folder_stands_for_cells_what_they_include_and_devices(spec: Path) -> None:
    spec.write_text("format: 1\ncell: x\ninclude: parts/hosts.yaml\n")
    for name in ("parts/hosts.yaml", "arm/device.yaml", "series/a.family.yaml", "other.yaml", "mycell.yaml"):
        (spec.parent / name).parent.mkdir(exist_ok=True)
        (spec.parent / name).write_text("hosts:   {}\n")
    run("format", str(spec.parent))
    told = {
        file.relative_to(spec.parent).as_posix() for file in spec.parent.rglob("*.yaml") if "   " in file.read_text()
    }
    assert told == {"other.yaml", "mycell.yaml"}


def test_standard_input_becomes_standard_output(monkeypatch: pytest.MonkeyPatch) -> None:
    ran = _piped(monkeypatch, _UGLY)
    assert (ran.code, ran.out, ran.err) == (0, _FORM, "")
    assert _piped(monkeypatch, _UGLY, "--check").code == 1
    assert _piped(monkeypatch, _FORM, "--check").code == 0


def test_line_that_a_runner_would_obey_does_not_come_out_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    ran = _piped(monkeypatch, "summary: |\n  ::stop-commands::x\n")
    assert (ran.code, ran.out) == (1, "")


def test_file_that_is_no_yaml_stays_and_is_told_with_its_place(spec: Path) -> None:
    spec.write_text("cell:   [x\n")
    ran = run("format", str(spec))
    assert ran.code == 1
    assert (
        f"error[not-yaml]: not valid YAML: the list in brackets is not closed\n --> {spec.as_posix()}:1:11" in ran.out
    )
    assert spec.read_text() == "cell:   [x\n"


def test_line_breaks_byte_order_mark_permissions_and_a_link_stay(spec: Path) -> None:
    spec.write_bytes(b"\xef\xbb\xbf" + _UGLY.replace("\n", "\r\n").encode())
    spec.chmod(0o640)
    link = spec.with_name("other.yaml")
    link.symlink_to(spec.name)
    assert run("format", str(link)).code == 0
    assert spec.read_bytes() == b"\xef\xbb\xbf" + _FORM.replace("\n", "\r\n").encode()
    assert spec.stat().st_mode & 0o777 == 0o640
    assert link.is_symlink()


def test_link_that_leads_out_is_not_followed(spec: Path) -> None:
    folder = spec.parent / "repository"
    folder.mkdir()
    (folder / "cell.yaml").symlink_to(spec)
    assert "leads out of its folder" in run("format", str(folder)).out
    assert spec.read_text() == _UGLY


def test_input_beside_files_is_a_wrong_call(spec: Path) -> None:
    assert run("format", "-", str(spec)).code == 2


def test_file_of_two_names_stays_one_file(spec: Path) -> None:
    other = spec.with_name("other.yaml")
    other.hardlink_to(spec)
    assert run("format", str(spec)).code == 0
    assert other.read_text() == _FORM
    assert other.stat().st_ino == spec.stat().st_ino
    assert sorted(path.name for path in spec.parent.iterdir()) == ["cell.yaml", "other.yaml"]
