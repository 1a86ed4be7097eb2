"""The generated folder changes as a whole or not at all, and nothing that people wrote in it is lost."""

from __future__ import annotations

import errno
import hashlib
import json
import os
from pathlib import Path

import pytest

from cellc.compiler.artifact import Artifact
from cellc.compiler.output.write import write
from cellc.contract.limits import limits
from cellc.contract.store.staging import make_staging
from cellc.contract.store.swap import Swap, write_whole
from cellc.mock.errors import MockError
from cellc.mock.evidence.folder import EvidenceFolder
from tests.cells import there
from tests.output.building import artifacts_of, as_contents, build_of, contents

FIRST = build_of(a_txt="one\n", b_txt="two\n", config__c_yaml="c: 1\n", old__d_txt="d\n")
SECOND = build_of(a_txt="changed\n", b_txt="two\n", config__c_yaml="c: 2\n", new__deep__e_txt="e\n")


def test_first_build_makes_the_folder_and_its_parents(tmp_path: Path) -> None:
    folder = tmp_path / "generated" / "small"
    report = there(write(FIRST, folder).value)
    assert report.written == ("a.txt", "b.txt", "config/c.yaml", "old/d.txt", "manifest.json")
    assert contents(tmp_path / "generated") == {f"small/{path}": text for path, text in as_contents(FIRST).items()}


def test_manifest_holds_the_hash_of_every_other_file(tmp_path: Path) -> None:
    write(FIRST, tmp_path / "small")
    files = json.loads((tmp_path / "small/manifest.json").read_text())["files"]
    assert files["a.txt"] == hashlib.sha256(b"one\n").hexdigest()
    assert sorted(files) == ["a.txt", "b.txt", "config/c.yaml", "old/d.txt"]


def test_next_build_changes_what_differs_and_removes_what_is_no_longer_made(tmp_path: Path) -> None:
    write(FIRST, tmp_path / "small")
    report = there(write(SECOND, tmp_path / "small").value)
    assert report.written == ("a.txt", "config/c.yaml", "new/deep/e.txt", "manifest.json")
    assert (report.removed, report.unchanged) == (("old/d.txt",), ("b.txt",))
    assert contents(tmp_path) == {f"small/{path}": text for path, text in as_contents(SECOND).items()}


def test_unchanged_file_keeps_inode_and_time(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    os.utime(tmp_path / "b.txt", (1, 1))
    before = (tmp_path / "b.txt").stat()
    write(SECOND, tmp_path)
    after = (tmp_path / "b.txt").stat()
    assert (before.st_ino, before.st_mtime_ns) == (after.st_ino, after.st_mtime_ns)


def test_second_build_of_the_same_cell_touches_nothing(tmp_path: Path) -> None:
    write(FIRST, tmp_path / "small")
    before = (tmp_path / "small").stat().st_mtime_ns, tmp_path.stat().st_mtime_ns
    report = there(write(FIRST, tmp_path / "small").value)
    assert report.written == report.removed == ()
    assert before == ((tmp_path / "small").stat().st_mtime_ns, tmp_path.stat().st_mtime_ns)


def test_file_of_people_beside_generated_ones_survives(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    (tmp_path / "notes.md").write_text("mine\n")
    (tmp_path / "old/mine.txt").write_text("mine\n")
    assert write(SECOND, tmp_path).ok
    assert contents(tmp_path) == as_contents(SECOND) | {"notes.md": "mine\n", "old/mine.txt": "mine\n"}


@pytest.mark.parametrize("edited", ["a.txt", "old/d.txt"])
def test_edit_of_a_generated_file_stops_the_build(edited: str, tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    (tmp_path / edited).write_text("edited\n")
    before = contents(tmp_path)
    outcome = write(SECOND, tmp_path)
    assert outcome.value is None
    assert [(d.code, Path(d.span.file)) for d in outcome.diagnostics] == [("edited-by-hand", tmp_path / edited)]
    assert contents(tmp_path) == before


def test_force_discards_an_edit(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    (tmp_path / "a.txt").write_text("edited\n")
    assert write(SECOND, tmp_path, force=True).ok
    assert contents(tmp_path) == as_contents(SECOND)


def test_edit_that_equals_the_new_build_is_no_edit(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    (tmp_path / "a.txt").write_text("changed\n")
    assert write(SECOND, tmp_path).ok


def test_file_of_people_in_the_place_of_a_generated_one_is_reported(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("mine\n")
    assert [d.code for d in write(FIRST, tmp_path).diagnostics] == ["edited-by-hand"]
    assert contents(tmp_path) == {"a.txt": "mine\n"}


def test_broken_manifest_makes_every_other_content_an_edit(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    (tmp_path / "manifest.json").write_text('{"files": 5}')
    assert [d.code for d in write(SECOND, tmp_path).diagnostics] == ["edited-by-hand", "edited-by-hand"]


def test_manifest_larger_than_a_file_of_a_folder_may_be_is_none(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    whole = (tmp_path / "manifest.json").read_text()
    (tmp_path / "manifest.json").write_text(whole + " " * limits().folder_bytes)
    assert [d.code for d in write(SECOND, tmp_path).diagnostics] == ["edited-by-hand", "edited-by-hand"]


def test_manifest_cannot_make_a_build_delete_other_files(tmp_path: Path) -> None:
    folder, other = tmp_path / "small", tmp_path / "precious.txt"
    other.write_text("mine\n")
    write(FIRST, folder)
    manifest = json.loads((folder / "manifest.json").read_text())
    digest = hashlib.sha256(b"mine\n").hexdigest()
    manifest["files"] |= {"../precious.txt": digest, other.as_posix(): digest}
    (folder / "manifest.json").write_text(json.dumps(manifest))
    assert write(SECOND, folder).ok
    assert other.read_text() == "mine\n"


@pytest.mark.parametrize("force", [False, True])
def test_manifest_and_a_link_cannot_make_a_build_delete_other_files(force: bool, tmp_path: Path) -> None:
    folder, other = tmp_path / "small", tmp_path / "other" / "deep" / "precious.txt"
    other.parent.mkdir(parents=True)
    other.write_text("mine\n")
    (tmp_path / "other" / "empty").mkdir()
    write(FIRST, folder)
    (folder / "link").symlink_to(tmp_path / "other")
    manifest = json.loads((folder / "manifest.json").read_text())
    digest = hashlib.sha256(b"mine\n").hexdigest()
    manifest["files"] |= {"link/deep/precious.txt": digest, "link/empty/gone.txt": digest}
    (folder / "manifest.json").write_text(json.dumps(manifest))
    assert write(SECOND, folder, force=force).ok
    assert contents(tmp_path / "other") == {"deep/precious.txt": "mine\n", "empty/": ""}


def test_swap_removes_and_puts_nothing_behind_a_link(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "a.txt").write_text("mine\n")
    (tmp_path / "small").mkdir()
    (tmp_path / "small" / "link").symlink_to(tmp_path / "other")
    swap = Swap(tmp_path / "small", make_staging(tmp_path / "small"))
    with pytest.raises(OSError, match="is a symbolic link"):
        swap.remove("link/a.txt")
    with pytest.raises(OSError, match="is a symbolic link"):
        swap.put("link/new/b.txt")
    assert contents(tmp_path / "other") == {"a.txt": "mine\n"}


@pytest.mark.parametrize("name", ["x\ud800", "x" * 300, "x/" * 2500 + "x", "x\u202ey"], ids=ascii)
def test_name_in_a_manifest_that_no_build_makes_is_no_name_of_a_file(name: str, tmp_path: Path) -> None:
    write(FIRST, tmp_path / "small")
    manifest = json.loads((tmp_path / "small/manifest.json").read_text())
    manifest["files"][name] = "0" * 64
    (tmp_path / "small/manifest.json").write_text(json.dumps(manifest))
    assert write(FIRST, tmp_path / "small").ok
    assert contents(tmp_path / "small") == as_contents(FIRST)


def test_link_above_the_folder_is_not_written_through(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "outside").mkdir()
    (tmp_path / "checkout").mkdir()
    (tmp_path / "checkout" / "generated").symlink_to(tmp_path / "outside")
    monkeypatch.chdir(tmp_path / "checkout")
    for folder in (Path("generated/deep/small"), Path.cwd() / "generated" / "small"):
        outcome = write(FIRST, folder, force=True)
        assert [found.code for found in outcome.diagnostics] == ["output-symlink"]
        with pytest.raises(OSError, match="is a symbolic link"):
            write_whole(folder / "records.jsonl", "text\n")
        with pytest.raises(MockError, match="is not a folder that evidence can be written to"):
            EvidenceFolder(folder / "evidence", ["report.html"])
    assert contents(tmp_path / "outside") == {}


@pytest.mark.parametrize(
    "path",
    [
        "../a",
        "/a",
        "a/../../b",
        "a//b",
        "",
        "a\\b",
        "a\nb",
        "C:a",
        "x" * 256,
        "./a",
        "nul",
        "config/AUX.yaml",
        "com1/a",
        "lpt9 .x",
    ],
)
def test_path_that_leads_elsewhere_or_nowhere_is_refused(path: str, tmp_path: Path) -> None:
    outcome = write([Artifact(path, "x\n")], tmp_path / "small")
    assert [d.code for d in outcome.diagnostics] == ["bad-artifact-path"]
    assert "\n" not in outcome.diagnostics[0].message
    assert contents(tmp_path) == {}


@pytest.mark.parametrize("paths", [("a/b", "A/B"), ("a", "a"), ("a", "a/b"), ("ä", "a\u0308")])
def test_paths_that_collide_are_refused(paths: tuple[str, str], tmp_path: Path) -> None:
    outcome = write([Artifact(path, "x\n") for path in paths], tmp_path / "small")
    assert [d.code for d in outcome.diagnostics] == ["bad-artifact-path"]
    assert contents(tmp_path) == {}


def test_file_in_the_place_of_the_folder_is_reported(tmp_path: Path) -> None:
    (tmp_path / "small").write_text("mine\n")
    assert [d.code for d in write(FIRST, tmp_path / "small").diagnostics] == ["output-blocked"]


def test_folder_in_the_place_of_a_file_is_reported(tmp_path: Path) -> None:
    (tmp_path / "a.txt/inner").mkdir(parents=True)
    assert [d.code for d in write(FIRST, tmp_path, force=True).diagnostics] == ["output-blocked"]


@pytest.mark.parametrize("link", [".", "config", "a.txt"])
def test_symbolic_link_is_not_written_through(link: str, tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (tmp_path / "file").write_text("mine\n")
    folder = tmp_path / "small"
    place = folder if link == "." else folder / link
    place.parent.mkdir(parents=True, exist_ok=True)
    place.symlink_to(tmp_path / "file" if link == "a.txt" else outside)
    outcome = write(FIRST, folder, force=True)
    assert [d.code for d in outcome.diagnostics] == ["output-symlink"]
    assert contents(outside) == {}
    assert (tmp_path / "file").read_text() == "mine\n"


@pytest.mark.parametrize("function", ["fsync", "replace", "mkdir", "unlink"])
@pytest.mark.parametrize("reason", [errno.ENOSPC, errno.EACCES, errno.EROFS])
def test_refusal_of_the_system_leaves_everything_as_it_was(
    function: str, reason: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(FIRST, tmp_path / "small")
    before = contents(tmp_path)
    real, calls = getattr(os, function), [0]

    def refuse(*arguments: object, **options: object) -> object:
        calls[0] += 1
        if calls[0] == {"replace": 2}.get(function, 1):
            raise OSError(reason, os.strerror(reason))
        return real(*arguments, **options)

    monkeypatch.setattr(os, function, refuse)
    outcome = write(SECOND, tmp_path / "small")
    monkeypatch.undo()
    assert [d.code for d in outcome.diagnostics] == ["output-unwritable"]
    assert os.strerror(reason).lower() in outcome.diagnostics[0].message
    assert contents(tmp_path) == before


def test_file_system_without_hard_links_is_written_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*arguments: object, **options: object) -> None:
        raise OSError(errno.EPERM, "no links")

    write(FIRST, tmp_path)
    monkeypatch.setattr(os, "link", refuse)
    assert write(SECOND, tmp_path).ok
    assert contents(tmp_path) == as_contents(SECOND)


def test_folder_whose_name_has_glob_characters_is_written(tmp_path: Path) -> None:
    assert write(artifacts_of({"a": "x\n"}), tmp_path / "s[m]*ll").ok


def test_of_a_file_in_the_place_of_an_artifact_no_more_is_read_than_cellc_writes(tmp_path: Path) -> None:
    folder = tmp_path / "small"
    write(FIRST, folder)
    with (folder / "a.txt").open("wb") as file:
        file.truncate(1 << 40)  # a hole: a terabyte that takes no room on the disk
    assert [found.code for found in write(SECOND, folder).diagnostics] == ["edited-by-hand"]
