"""The steps of a swap one by one, what links on the way mean, and what a build leaves behind."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from cellc.compiler.output.write import write
from cellc.contract.store.cache import read_entry, write_entry
from cellc.contract.store.cache_key import cache_key
from cellc.contract.store.staging import discard, make_staging
from cellc.contract.store.swap import Swap, link_above, link_on_the_way, write_whole
from cellc.mock.command.records import write_records
from cellc.mock.errors import MockError
from cellc.mock.evidence.folder import EvidenceFolder
from tests.output.building import as_contents, build_of, contents, staging_at_work


def _swap(tmp_path: Path) -> Swap:
    folder = tmp_path / "out"
    staging = make_staging(folder)
    (staging / "new" / "a" / "b").mkdir(parents=True)
    (staging / "new" / "a" / "b" / "c.txt").write_text("new\n")
    return Swap(folder, staging)


def test_folders_above_a_new_file_are_made_and_go_again(tmp_path: Path) -> None:
    swap = _swap(tmp_path)
    swap.put("a/b/c.txt")
    assert (tmp_path / "out/a/b/c.txt").read_text() == "new\n"
    swap.undo()
    assert list(tmp_path.iterdir()) == []


def test_folder_that_was_there_and_what_is_in_it_stay(tmp_path: Path) -> None:
    (tmp_path / "out" / "a").mkdir(parents=True)
    (tmp_path / "out" / "a" / "own.txt").write_text("own\n")
    swap = _swap(tmp_path)
    swap.make_folder(tmp_path / "out" / "a" / "b" / "d")
    swap.put("a/b/c.txt")
    (tmp_path / "out" / "a" / "b" / "d" / "somebody.txt").write_text("mine\n")
    swap.undo()
    left = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert left == {"out/a/own.txt", "out/a/b/d/somebody.txt"}


def test_lock_of_a_staging_folder_goes_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As long as anything is in it, others see that its process runs."""
    staging = make_staging(tmp_path / "out")
    (staging / "new").mkdir()
    (staging / "new" / "a.txt").touch()
    (staging / "record.txt").touch()
    before_it_goes = []

    def removed(folder: Path, *, ignore_errors: bool = False) -> None:
        if folder == staging:
            before_it_goes.append([path.name for path in staging.iterdir()])
        remove(folder, ignore_errors=ignore_errors)

    remove = shutil.rmtree
    monkeypatch.setattr(shutil, "rmtree", removed)
    discard(staging)
    assert before_it_goes == [[".cellc-lock"]]
    assert not staging.exists()


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a link in it, behind a link of the user."""
    (tmp_path / "disk" / "bench" / "real").mkdir(parents=True)
    (tmp_path / "home").symlink_to("disk", target_is_directory=True)
    (tmp_path / "disk" / "bench" / "linked").symlink_to("real", target_is_directory=True)
    monkeypatch.chdir(tmp_path / "disk" / "bench")
    return Path.cwd()


@pytest.mark.parametrize(
    ("place", "found"),
    [
        ("linked/out", "linked"),  # as it was written
        ("linked", "linked"),
        ("real/out", None),
        ("{here}/linked/out", "{here}/linked"),  # the same, absolute
        ("{here}/real/out", None),
        ("{above}/home/bench/real/out", None),  # a link of the user, outside of the current folder
        ("{above}/disk/elsewhere", None),
    ],
)
def test_link_is_found_below_the_current_folder_alone(place: str, found: str | None, here: Path) -> None:
    names = {"here": here, "above": here.parents[1]}
    expected = None if found is None else Path(found.format_map(names))
    assert link_on_the_way(Path(place.format_map(names))) == expected


@pytest.mark.parametrize(
    ("path", "found"),
    [("linked/a/b", "linked"), ("real/b", None), ("linked", None), ("b", None)],  # the file itself is not above
)
def test_link_above_a_file_is_the_first_from_the_folder(path: str, found: str | None, here: Path) -> None:
    assert link_above(path, here) == (None if found is None else here / found)


_DEAD = 2**22 + 1
"""No process has this number: it is above the largest that Linux gives out."""

FIRST = build_of(a_txt="one\n", b_txt="two\n")
SECOND = build_of(a_txt="changed\n", b_txt="two\n")
THIRD = build_of(a_txt="one\n", b_txt="2\n", c_txt="three\n")


@pytest.mark.parametrize("maker", [str(_DEAD), f"0123abcd-{_DEAD}"])
def test_half_a_file_of_a_killed_process_goes_with_the_next_one(maker: str, tmp_path: Path) -> None:
    for name in ("cell.yaml", "records.jsonl"):
        (tmp_path / f".{name}.tmp-{maker}").write_text("half")
    write_whole(tmp_path / "cell.yaml", "text\n")
    write_records(tmp_path / "records.jsonl", ())
    assert contents(tmp_path) == {"cell.yaml": "text\n", "records.jsonl": ""}


def test_half_an_entry_of_a_killed_process_goes_with_the_next_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("CELLC_NO_CACHE", raising=False)
    assert cache_key(None) is not None  # that was made before
    with monkeypatch.context() as killed:
        killed.setattr(os, "getpid", lambda: _DEAD)
        killed.setattr(os, "replace", lambda *_paths: None)
        killed.setattr(Path, "unlink", lambda *_paths, **_options: None)
        write_entry("kind/entry.json", b"content")
    assert len([path for path in tmp_path.rglob("*") if path.is_file()]) == 1
    write_entry("kind/entry.json", b"content")
    assert [path.name for path in tmp_path.rglob("*") if path.is_file()] == ["entry.json"]
    assert read_entry("kind/entry.json") == b"content"


def test_half_a_file_of_a_process_that_runs_is_left_to_it(tmp_path: Path) -> None:
    # Process 1 is alive on every POSIX system.
    (tmp_path / ".cell.yaml.tmp-1").write_text("half")
    write_whole(tmp_path / "cell.yaml", "text\n")
    assert contents(tmp_path) == {".cell.yaml.tmp-1": "half", "cell.yaml": "text\n"}


@pytest.mark.parametrize("name", [".small.tmp-mine", ".small.tmp-", ".small.tmp-1a", ".smaller.tmp-4194305"])
def test_a_name_that_only_looks_temporary_is_somebodys_own(name: str, tmp_path: Path) -> None:
    (tmp_path / name).mkdir()
    (tmp_path / name / "notes.txt").write_text("mine")
    assert write(FIRST, tmp_path / "small").ok
    assert (tmp_path / name / "notes.txt").read_text() == "mine"


def test_a_killed_build_whose_process_had_the_same_number_is_healed(tmp_path: Path) -> None:
    # As every first process of a container has the number 1.
    folder, left = tmp_path / "small", tmp_path / f".small.tmp-{os.getpid()}"
    write(SECOND, tmp_path / "other" / "small")
    write(FIRST, folder)
    left.mkdir(0o1777)
    (tmp_path / "other" / "small").rename(left / "new")
    (folder / "a.txt").write_text("changed\n")  # it had replaced this one, and not yet the manifest
    assert write(THIRD, folder).ok
    assert _files(tmp_path) == {f"small/{path}": text for path, text in as_contents(THIRD).items()}


@pytest.mark.skipif(sys.platform != "linux", reason="other systems make no folder with a sticky bit")
def test_what_a_stranger_calls_a_staging_folder_neither_holds_builds_up_nor_excuses_an_edit(tmp_path: Path) -> None:
    folder = tmp_path / "small"
    write(FIRST, folder)
    (tmp_path / ".small.tmp-1").mkdir()  # process 1 lives for ever
    forged = tmp_path / ".small.tmp-4194305" / "new"  # above the highest number of a process, proc(5) pid_max
    forged.mkdir(parents=True)
    (folder / "a.txt").write_text("mine\n")
    digest = hashlib.sha256(b"mine\n").hexdigest()
    (forged / "manifest.json").write_text(json.dumps({"format": 1, "files": {"a.txt": digest}}))
    assert [found.code for found in write(SECOND, folder).diagnostics] == ["edited-by-hand"]
    (folder / "a.txt").write_text(as_contents(FIRST)["a.txt"])
    assert write(SECOND, folder).ok


def test_of_two_builds_that_begin_at_once_the_later_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "small"
    write(FIRST, folder)
    _meanwhile(monkeypatch, lambda: staging_at_work(tmp_path / ".small.tmp-1"))
    assert [found.code for found in write(SECOND, folder).diagnostics] == ["output-busy"]
    assert contents(tmp_path) == {
        ".small.tmp-1/.cellc-lock": "",
        **{f"small/{path}": text for path, text in as_contents(FIRST).items()},
    }


def test_a_build_that_another_one_overtook_leaves_no_mixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "small"
    write(FIRST, folder)
    _meanwhile(monkeypatch, lambda: write(THIRD, folder))
    assert write(SECOND, folder).ok
    assert contents(folder) == as_contents(SECOND)


def test_a_build_that_was_overtaken_before_it_had_its_lock_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "small"
    write(FIRST, folder)
    real = os.mkdir

    def mkdir(place: Path, mode: int = 0o777) -> None:
        monkeypatch.undo()
        real(place, mode)
        child = os.fork()  # another build, from its start to its end: it finds a staging folder without a lock
        if child == 0:
            os._exit(0 if write(THIRD, folder).ok else 1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0

    monkeypatch.setattr(os, "mkdir", mkdir)
    assert [found.code for found in write(SECOND, folder).diagnostics] == ["output-busy"]
    assert contents(tmp_path) == {f"small/{path}": text for path, text in as_contents(THIRD).items()}


def test_a_folder_that_another_build_makes_meanwhile_is_no_refusal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    parent = tmp_path / "generated"
    _meanwhile(monkeypatch, parent.mkdir, "generated")
    assert write(FIRST, parent / "small").ok
    assert contents(parent / "small") == as_contents(FIRST)


def test_an_edit_made_while_a_build_began_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "small"
    write(FIRST, folder)
    _meanwhile(monkeypatch, lambda: (folder / "a.txt").write_text("mine\n"))
    assert [found.code for found in write(SECOND, folder).diagnostics] == ["edited-by-hand"]
    assert contents(tmp_path) == {
        f"small/{path}": text for path, text in {**as_contents(FIRST), "a.txt": "mine\n"}.items()
    }


def test_of_two_runs_that_begin_at_once_the_later_writes_no_evidence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _meanwhile(monkeypatch, lambda: staging_at_work(tmp_path / ".evidence.tmp-1"))
    with pytest.raises(MockError, match="another run is writing"):
        EvidenceFolder(tmp_path / "evidence", ["report.html"])
    assert contents(tmp_path) == {".evidence.tmp-1/.cellc-lock": ""}


def _files(folder: Path) -> dict[str, str]:
    return {path: text for path, text in contents(folder).items() if not path.endswith("/")}


def _meanwhile(monkeypatch: pytest.MonkeyPatch, act: Callable[[], object], before: str = ".tmp-") -> None:
    """Let something happen once, right before a process makes a folder: its staging folder."""
    real = os.mkdir
    happened: list[Path] = []

    def mkdir(path: Path, *arguments: int) -> None:
        if before in Path(path).name and not happened:
            happened.append(path)
            act()
        real(path, *arguments)

    monkeypatch.setattr(os, "mkdir", mkdir)
