"""What is compared with is what the repository has at that revision, whatever a branch holds that looks like one."""

from __future__ import annotations

import os
import shutil
import zlib
from pathlib import Path

import pytest

from cellc.tools.review.objects import RevisionError
from cellc.tools.review.revisions import repository_of
from tests.cells import spec_text
from tests.cli.run import run
from tests.review.revisions import SMALL, Repository, new_repository

CHANGED = spec_text("minimal").replace("path_tolerance: 0.2 rad", "path_tolerance: 0.1 rad")


@pytest.fixture(name="genuine")
def genuine_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Repository:
    """A repository whose work tree has another tolerance than its `main`."""
    assert spec_text("minimal") != CHANGED
    (tmp_path / "repository").mkdir()
    repository = new_repository(tmp_path / "repository", SMALL)
    repository.write(CHANGED, SMALL)
    monkeypatch.chdir(repository.folder)
    return repository


@pytest.fixture(name="forged")
def forged_fixture(tmp_path: Path) -> Path:
    """The `.git` of a repository whose `main` has the other tolerance already, at the paths of both."""
    forged = Repository(tmp_path / "forged")
    forged.folder.mkdir()
    forged.git("init", "-q", "-b", "main")
    for path in (SMALL, "cell.yaml"):
        forged.write(CHANGED, path)
    forged.git("add", "-A")
    forged.git("commit", "-q", "-m", "forged")
    return forged.folder / ".git"


def _text(folder: Path, revision: str = "main") -> str:
    with repository_of(folder).taken(revision, SMALL) as taken:
        return taken.path.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", [".", ".git"], ids=["bare", "nested"])
def test_a_repository_inside_of_the_checkout_is_no_base(name: str, genuine: Repository, forged: Path) -> None:
    shutil.copytree(forged, genuine.folder / "cells/minimal" / name, dirs_exist_ok=True)
    ran = run("diff", "main", SMALL)
    assert (ran.code, ran.err) == (1, "")
    assert "path tolerance" in ran.out.replace("_", " ")


@pytest.mark.parametrize("name", ["main", "main..HEAD", f"main:{SMALL}"])
def test_a_file_named_as_a_revision_is_no_base(name: str, genuine: Repository) -> None:
    genuine.write(CHANGED, name)
    ran = run("diff", name, SMALL)
    assert (ran.code, "is a revision and a file" in ran.err) == (2, True)
    assert run("diff", f"./{name}", SMALL).code == 0


def test_a_replaced_object_is_not_read(genuine: Repository) -> None:
    genuine.git("commit", "-q", "-a", "-m", "changed")
    genuine.git("branch", "changed")
    genuine.git("reset", "-q", "--hard", "HEAD~1")
    genuine.git("replace", "main", "changed")
    assert CHANGED.strip() == genuine.git("show", f"main:{SMALL}")
    assert _text(genuine.folder) == spec_text("minimal")


@pytest.mark.parametrize("named", [f"main:{SMALL}", "main:cells", "main"])
def test_an_object_that_is_not_as_its_id_says_is_refused(named: str, genuine: Repository) -> None:
    identity = genuine.git("rev-parse", named)
    file = genuine.folder / ".git/objects" / identity[:2] / identity[2:]
    content = zlib.decompress(file.read_bytes())
    kind, _, size = content.partition(b"\0")[0].partition(b" ")
    forged = content[: -int(size)] + content[-int(size) :].replace(b"0.2 rad", b"0.1 rad").replace(b"nobody", b"Nobody")
    forged = forged.replace(b"minimal", b"maximal") if kind == b"tree" else forged
    assert forged != content
    file.chmod(0o600)
    file.write_bytes(zlib.compress(forged))
    with pytest.raises(RevisionError, match=r"has a damaged (blob|tree) \w+|there is no revision"):
        _text(genuine.folder)


_ID = bytes(20)
# Each fits its id; what git itself would not write, `hash-object --literally` does.
_TREES = {
    "cut in an id": b"100644 cell.yaml\0" + _ID[:7],
    "no end of a name": b"100644 cell.yaml",
    "no mode": b" cell.yaml\0" + _ID,
    "no number as a mode": b"blob cell.yaml\0" + _ID,
    "a zero alone": b"\0",
}


@pytest.mark.parametrize("content", _TREES.values(), ids=_TREES)
def test_a_tree_that_is_not_well_formed_is_refused(content: bytes, genuine: Repository) -> None:
    ran = run("diff", _commit_of(genuine, content), SMALL)
    assert (ran.code, "that is not well formed" in ran.err) == (2, True), ran
    assert "Traceback" not in ran.err


@pytest.mark.parametrize("name", ["../../../../outside", "..", ".", "", "/outside", "a/../../../../../outside", ".git"])
def test_a_name_in_a_tree_leads_nowhere_else(name: str, genuine: Repository, tmp_path: Path) -> None:
    before = {path for path in tmp_path.rglob("*") if ".git" not in path.parts}
    blob = bytes.fromhex(genuine.git("rev-parse", f"main:{SMALL}"))
    names = sorted([(name.encode(), blob), (b"cell.yaml", blob)])
    content = b"".join(b"100644 %s\0%s" % entry for entry in names)
    ran = run("diff", _commit_of(genuine, content), SMALL)
    assert ran.code in (1, 2), ran
    assert "Traceback" not in ran.err
    assert {path for path in tmp_path.rglob("*") if ".git" not in path.parts} == before


def _commit_of(repository: Repository, content: bytes) -> str:
    """Return a commit that has these bytes as the tree of the cell's folder."""
    file = repository.folder.parent / "tree"
    file.write_bytes(content)
    below = repository.git("hash-object", "-t", "tree", "-w", "--literally", "--no-filters", str(file))
    for folder in reversed(Path(SMALL).parent.parts):
        file.write_bytes(b"40000 %s\0%s" % (folder.encode(), bytes.fromhex(below)))
        below = repository.git("hash-object", "-t", "tree", "-w", "--literally", str(file))
    file.unlink()
    return repository.git("commit-tree", "-m", "forged", below)


def test_a_work_tree_and_a_submodule_answer_for_their_files(genuine: Repository, forged: Path, tmp_path: Path) -> None:
    genuine.git("worktree", "add", "-q", "--detach", str(tmp_path / "tree"), "main")
    assert (tmp_path / "tree/.git").is_file()
    assert _text(tmp_path / "tree/cells") == spec_text("minimal")
    genuine.git("-c", "protocol.file.allow=always", "submodule", "--quiet", "add", str(forged.parent), "sub")
    assert (genuine.folder / "sub/.git").is_file()
    assert repository_of(genuine.folder / "sub/cells").top == genuine.folder / "sub"
    assert _text(genuine.folder / "sub/cells") == CHANGED
    assert _text(genuine.folder) == spec_text("minimal")


def test_a_repository_of_another_user_is_refused(genuine: Repository) -> None:
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        pytest.skip("only root can give a folder to another user")
    for place in (genuine.folder, genuine.folder / ".git"):
        os.chown(place, 12345, 12345)
    with pytest.raises(RevisionError, match="not in a readable Git repository"):
        repository_of(genuine.folder)


def test_a_folder_in_sha256_is_read(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    repository.git("init", "-q", "-b", "main", "--object-format=sha256")
    repository.write(CHANGED, SMALL)
    repository.git("add", "-A")
    repository.git("commit", "-q", "-m", "new")
    assert _text(tmp_path) == CHANGED
