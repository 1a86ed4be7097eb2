"""Repositories, names and packages of strangers: nothing of them is run, obeyed or read past its bounds."""

from __future__ import annotations

import os
import stat
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.contract.limits import DEFAULTS, in_force
from cellc.tools.review import objects
from cellc.tools.review.facts import FactsError, facts_of
from cellc.tools.review.lines import Known, lines_left
from cellc.tools.review.objects import Entry, RevisionError
from cellc.tools.review.revisions import repository_of
from cellc.tools.review.sides import Package
from cellc.tools.review.tokens import tokens
from tests.cells import spec_text
from tests.cli.run import run
from tests.review.revisions import SMALL, SPEC, Repository, edited, new_repository

_MOCK = "urdf/ur5e_pick.mock.urdf"
NOBODY = Known(frozenset(), frozenset(), frozenset())


@pytest.fixture
def hostile(tmp_path: Path) -> Repository:
    """Return a repository that would run a program at every occasion that git offers, and leave a file behind."""
    (tmp_path / "repository").mkdir()
    repository = new_repository(tmp_path / "repository", SMALL)
    trap = tmp_path / "trap"
    trap.write_text(f"#!/bin/sh\ntouch {tmp_path / 'sprung'}\ncat\n", encoding="utf-8")
    trap.chmod(stat.S_IRWXU)
    for name in ("post-checkout", "post-index-change", "reference-transaction", "fsmonitor-watchman"):
        os.symlink(trap, repository.folder / ".git" / "hooks" / name)
    repository.write("* filter=trap diff=trap\n", ".gitattributes")
    repository.git("add", ".gitattributes")
    repository.git("-c", "core.hooksPath=/dev/null", "commit", "-q", "-m", "attributes")
    for key in (
        "core.fsmonitor",
        "core.pager",
        "diff.external",
        "diff.trap.textconv",
        "filter.trap.smudge",
        "core.editor",
    ):
        repository.git("config", key, str(trap))
    (tmp_path / "sprung").unlink(missing_ok=True)
    return repository


def test_no_program_that_a_repository_names_is_run(
    hostile: Repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(hostile.folder)
    for name in ("GIT_EXTERNAL_DIFF", "GIT_PAGER", "GIT_SSH_COMMAND", "GIT_ASKPASS"):
        monkeypatch.setenv(name, str(tmp_path / "trap"))
    before = sorted(path.as_posix() for path in hostile.folder.rglob("*"))
    assert run("diff", SMALL).code == 0
    assert not (tmp_path / "sprung").exists()
    assert sorted(path.as_posix() for path in hostile.folder.rglob("*")) == before


@pytest.mark.parametrize("name", ["HEAD", "config", "packed-refs", "objects/info/alternates"])
def test_a_pipe_in_a_repository_is_not_waited_for(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert objects._PATIENCE_S <= 10
    monkeypatch.setattr(objects, "_PATIENCE_S", 1)
    repository = new_repository(tmp_path, SMALL)
    pipe = repository.folder / ".git" / name
    pipe.unlink(missing_ok=True)
    os.mkfifo(pipe)
    monkeypatch.chdir(repository.folder)
    ended = run("diff", SMALL)
    assert ended.code == 2
    assert "git must answer within 1 s; look for a pipe below `.git`" in ended.err


def test_variables_of_a_hook_choose_no_other_repository(
    repository: Repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GIT_DIR", str(tmp_path))
    monkeypatch.setenv("GIT_WORK_TREE", str(tmp_path))
    with repository_of(repository.folder).taken("main", SPEC) as taken:
        assert taken.path.read_text(encoding="utf-8") == edited()


@pytest.mark.parametrize(
    "name",
    ["a;touch sprung", "$(touch${IFS}sprung)", "--output=sprung", "`id`", "a\x1b[31mb", "@{99}", "a|b"],
)
def test_a_name_of_a_revision_is_a_name(name: str, repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(repository.folder)
    ran = run("diff", "--", f"{name}..main", SPEC)
    assert ran.code == 2
    assert "\x1b" not in ran.err
    assert not (repository.folder / "sprung").exists()


def test_a_branch_and_a_folder_with_odd_names_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    repository = Repository(tmp_path)
    repository.git("init", "-q", "-b", "main")
    odd = "cells/a b;$(id) ü:[x]*/cell.yaml"
    repository.write(edited(cell="minimal"), odd)
    repository.git("add", "-A")
    repository.git("commit", "-q", "-m", "odd")
    repository.git("branch", "a;$(id)'\"&ü")
    monkeypatch.chdir(tmp_path)
    ran = run("diff", "a;$(id)'\"&ü..main", odd)
    assert (ran.code, ran.err) == (0, "")


def test_a_link_in_a_revision_is_not_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    repository = new_repository(tmp_path, SMALL)
    os.symlink("/etc/passwd", tmp_path / "cells/minimal/extra.yaml")
    os.symlink("cell.yaml", tmp_path / "cells/minimal/link.yaml")
    repository.git("add", "-A")
    repository.git("commit", "-q", "-m", "links")
    monkeypatch.chdir(tmp_path)
    ran = run("diff", "main", SMALL)
    assert ran.code == 0
    assert f"note: main:{SMALL}: 2 links or submodules were left out" in ran.out.splitlines()
    ran = run("diff", "main", "cells/minimal/link.yaml")
    assert ran.code == 2
    assert "is a link, which is not followed" in ran.err


@pytest.mark.parametrize("field", ["folder_entries", "folder_total_bytes", "mesh_bytes"])
def test_a_revision_with_more_than_is_read_is_refused(field: str, tmp_path: Path) -> None:
    repository = new_repository(tmp_path)
    repository.commit("x" * 100, "cells/ur5e_pick/more.txt")
    option = f"--limit {field.replace('_', '-')}=N"
    few = replace(DEFAULTS, **{field: 1})
    with pytest.raises(RevisionError, match=option), in_force(few), repository_of(tmp_path).taken("HEAD", SPEC):
        pass


def test_a_package_that_would_grow_is_refused(main: Package) -> None:
    bomb = "a: &a [x, x]\nb: &b [*a, *a]\nc: [*b, *b]\n"
    deep = "[" * 5000 + "]" * 5000
    for text in (bomb, deep, "a: [", "!!python/object:os.system {}"):
        with pytest.raises(FactsError, match=r"config/drivers\.yaml: "):
            facts_of({**main.files, "config/drivers.yaml": text})


def test_a_missing_or_broken_file_is_told_by_name(main: Package) -> None:
    for path in (
        "contract.json",
        "manifest.json",
        "rehearsals.json",
        "config/bring_up.json",
        "urdf/ur5e_pick.real.urdf",
    ):
        for files in ({**main.files, path: "<"}, {name: text for name, text in main.files.items() if name != path}):
            with pytest.raises(FactsError, match=path):
                facts_of(files)


def test_long_lines_and_many_lines_cost_no_square() -> None:
    # Each of them takes minutes where the work grows with the square.
    assert len(tokens("1 " * 100_000)) == 100_000
    assert len(tokens("1" * 200_000)) == 1
    assert len(tokens("a." * 100_000)) >= 1
    many = tuple(f"line {number}" for number in range(4_000))
    other = tuple(f"row {number}" for number in range(4_000))
    assert len(lines_left({"a": many}, {"a": other}, NOBODY)[0].before) == 4_000


def _commit_of_folder(repository: Repository, *entries: tuple[str, str, str], depth: int = 0) -> str:
    """Return a commit whose cell lies beside entries that `git add` would not write."""

    def stored(kind: str, content: bytes) -> str:
        command = ["git", "hash-object", "-t", kind, "--literally", "-w", "--stdin"]
        done = subprocess.run(command, cwd=repository.folder, input=content, check=True, capture_output=True)
        return done.stdout.decode().strip()

    def tree(*listed: tuple[str, str, str]) -> str:
        return stored("tree", b"".join(f"{mode} {name}\0".encode() + bytes.fromhex(one) for mode, name, one in listed))

    spec = ("100644", "cell.yaml", stored("blob", spec_text("minimal").encode()))
    below = tree(spec)
    for _ in range(depth):
        below = tree(("40000", "d", below))
    folders = [("40000", "d", below)] if depth else []
    named = [(mode, name, {"blob": spec[2], "tree": below}[kind]) for mode, name, kind in entries]
    top = tree(("40000", "cells", tree(("40000", "minimal", tree(spec, *folders, *named)))))
    return stored("commit", f"tree {top}\nauthor a <a> 0 +0000\ncommitter a <a> 0 +0000\n\nx\n".encode())


@pytest.mark.parametrize(
    ("entries", "depth"),
    [
        ([("100644", "n" * 300, "blob")], 0),
        ([("100644", "a", "blob"), ("40000", "a", "tree")], 0),
        ([("100644", ".", "blob")], 0),
        ([("100644", "", "blob")], 0),
        ([], 70),
    ],
    ids=["a long name", "a file and a folder", "the folder itself", "no name", "a deep folder"],
)
def test_a_tree_that_no_folder_can_be_is_refused(
    entries: list[tuple[str, str, str]], depth: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    repository = new_repository(tmp_path, SMALL)
    monkeypatch.chdir(tmp_path)
    ran = run("diff", _commit_of_folder(repository, *entries, depth=depth), SMALL)
    assert (ran.code, ran.out, ran.err.count("\n")) == (2, "", 1), ran.err


def test_a_tree_is_not_listed_beyond_what_is_read(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    repository = new_repository(tmp_path, SMALL)
    for name in range(40):
        for inside in range(40):
            repository.write("x", f"cells/minimal/{name}/{inside}")
    commit = repository.commit(spec_text("minimal"), SMALL)
    listed: list[str] = []
    whole = objects._listed

    def counted(tree: bytes, identity: str) -> Iterator[Entry]:
        listed.append(identity)
        return whole(tree, identity)

    monkeypatch.setattr(objects, "_listed", counted)
    with in_force(replace(DEFAULTS, folder_entries=100)), pytest.raises(RevisionError, match="folder-entries"):
        repository_of(tmp_path).objects.files(Entry("40000", repository.git("rev-parse", f"{commit}^{{tree}}"), ""))
    assert len(listed) < 10
