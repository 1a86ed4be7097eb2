"""Folders that others made to harm: each file is named with why, nothing is followed, and nothing is printed raw."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from cellc.contract.limits import MIB
from tests.cli.run import run
from tests.evidence.attempts import observe, package, ticked

PACKAGE = ("--package", package("ur5e_pick").as_posix())
_RESULT = "Result (passed or stopped): "
_OBSERVED = "observe-G4-20261128T101500Z.json"


def _linked(folder: Path) -> None:
    (folder.parent / "outside.md").write_text("secret\n", encoding="utf-8")
    (folder / "G4-transitions.md").symlink_to("../outside.md")


def _large(folder: Path) -> None:
    with (folder / "G4-transitions.md").open("wb") as file:
        file.truncate(5 * MIB)  # no byte of it is on the disk


def _deep(folder: Path) -> None:
    (folder / _OBSERVED).write_text("[" * 100_000 + "]" * 100_000, encoding="utf-8")


def _many(folder: Path) -> None:
    for number in range(10_001):
        (folder / f"{number:05}.txt").touch()


def _below(folder: Path) -> None:
    place = folder.joinpath(*"123456789")
    place.mkdir(parents=True)
    (place / "G4-transitions.md").write_text("done\n", encoding="utf-8")


_HOSTILE: dict[str, tuple[Callable[[Path], object], str]] = {
    "a link out of the folder": (_linked, "is a symbolic link, which is not followed"),
    "a large file": (_large, "is larger than 4194304 bytes; "),
    "deep JSON": (_deep, "is not JSON"),
    "binary": (lambda folder: (folder / _OBSERVED).write_bytes(b"\x00\xff\xfe"), "must be text in UTF-8"),
    "UTF-16": (lambda folder: (folder / "G4-transitions.md").write_bytes("done".encode("utf-16")), "must be text in"),
    "a list": (lambda folder: (folder / _OBSERVED).write_text("[1]"), "should be an object"),
    "a number that is none": (
        lambda folder: (folder / _OBSERVED).write_text('{"seconds": NaN}'),
        "must be a finite number",
    ),
    "a verdict that is none": (
        lambda folder: _edited(
            folder, lines=[{"part": "", "subject": "", "verdict": "ok", "expected": "", "seen": ""}]
        ),
        "verdict",
    ),
    "a pipe": (lambda folder: os.mkfifo(folder / "G4-transitions.md"), "must be a file or a folder"),
    "a folder in the place of a file": (
        lambda folder: (folder / "G4-transitions.md").mkdir(),
        "missing",
    ),
    "a file in the place of a recording": (
        lambda folder: (folder / "G6-bag").write_text("x"),
        "must be the folder of a recording",
    ),
    "a name that hides": (
        lambda folder: (folder / "a\x1b[2Jb\u202e").touch(),
        "must have a name of printable characters",
    ),
    "too many files": (_many, "holds more than 10000 files"),
    "too deep": (_below, "is deeper than 8 folders"),
    "an index that leaves the folder": (
        lambda folder: (folder / "evidence.json").write_text(
            json.dumps({"cell": "ur5e_pick", "configuration_id": _own(), "seed": 0, "files": {"../../x": "0"}})
        ),
        "names a file outside of its folder",
    ),
}


def _own() -> str:
    text = (package("ur5e_pick") / "manifest.json").read_text(encoding="utf-8")
    return str(json.loads(text)["configuration_id"])


def _edited(folder: Path, **fields: object) -> None:
    place = observe(folder, "ur5e_pick", "G4")
    place.write_text(json.dumps({**json.loads(place.read_text(encoding="utf-8")), **fields}), encoding="utf-8")


@pytest.mark.parametrize(
    "text",
    [
        "\n" * 3_000_000,
        " " * 3_000_000 + "x",
        "- [ ] " + " " * 3_000_000 + "x",
        _RESULT + " Name: " * 200_000 + " Date, time: " * 200_000,
    ],
    ids=["lines", "blanks", "a box", "blanks to fill in"],
)
def test_a_text_that_is_made_to_be_read_for_hours_is_read(text: str, tmp_path: Path) -> None:
    (tmp_path / "network.md").write_text(f"## L1 Physical\n{text}", encoding="utf-8")
    (tmp_path / "G0-inventory.md").write_text(text, encoding="utf-8")
    ran = run("evidence", tmp_path.as_posix(), *PACKAGE, "--gate", "L1")
    assert "network.md: is no copy of gates/network.md of this package: L1 differs" in ran.out


def test_all_files_together_are_bounded(tmp_path: Path) -> None:
    for number in range(70):
        with (tmp_path / f"{number:02}.md").open("wb") as file:
            file.truncate(4 * MIB)  # no byte of it is on the disk
    ran = run("evidence", tmp_path.as_posix(), *PACKAGE, "--gate", "L1")
    assert "69.md: exceeds what is read of a folder; " in ran.out
    assert "63.md: exceeds" not in ran.out


@pytest.mark.parametrize("output_format", ["text", "json", "html"])
@pytest.mark.parametrize("what", _HOSTILE)
def test_each_is_a_finding_with_its_reason(what: str, output_format: str, tmp_path: Path) -> None:
    spoil, why = _HOSTILE[what]
    folder = tmp_path / "E"
    folder.mkdir()
    spoil(folder)
    ran = run("evidence", folder.as_posix(), *PACKAGE, "--format", output_format)
    assert (ran.code, ran.err) == (1, "")
    assert why in ran.out
    assert "secret" not in ran.out
    assert not {"\x1b", "\u202e"} & set(ran.out)


def test_texts_of_a_report_are_values_and_never_markup(tmp_path: Path) -> None:
    line = {
        "part": "graph",
        "subject": "<script>alert(1)</script>",
        "verdict": "FAILED",
        "expected": "\u202e&",
        "seen": "\x1b[2J",
    }
    _edited(tmp_path, lines=[line], host="::error::<b>")
    for output_format in ("text", "json", "html"):
        ran = run("evidence", tmp_path.as_posix(), *PACKAGE, "--format", output_format)
        assert ran.code == 1
        assert not {"\x1b", "\u202e"} & set(ran.out)
        assert not [each for each in ran.out.splitlines() if each.lstrip().startswith("::")]
    assert "<script" not in ran.out
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in ran.out


def test_findings_of_one_kind_are_counted_after_twenty(tmp_path: Path) -> None:
    lines = [
        {"part": "graph", "subject": f"/t{n}", "verdict": "FAILED", "expected": "", "seen": "x"} for n in range(50)
    ]
    _edited(tmp_path, lines=lines)
    ran = run("evidence", tmp_path.as_posix(), *PACKAGE, "--gate", "G4", "--format", "json")
    findings = json.loads(ran.out)["gates"][0]["findings"]
    failed = [finding["text"] for finding in findings if finding["status"] == "FAILED"]
    assert (len(failed), failed[-1]) == (21, "and 30 more")


def test_a_bound_is_raised_by_its_option(tmp_path: Path) -> None:
    (tmp_path / "L2-identity.md").write_text("x\n" * (3 * MIB), encoding="utf-8")
    ticked(tmp_path, "ur5e_pick")
    words = ("evidence", tmp_path.as_posix(), *PACKAGE, "--gate", "L2")
    assert "L2 Vendor interface: UNKNOWN" in run(*words).out
    assert "L2 Vendor interface: complete" in run(*words, "--limit", f"folder-bytes={8 * MIB}").out
