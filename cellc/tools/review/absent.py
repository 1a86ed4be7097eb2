"""What to run where a side is not there: a cell that was not built, a spec that had another path, a folder of cells."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from shlex import quote

from cellc.contract.store.regular_file import open_regular
from cellc.tools.review.facts import MANIFEST
from cellc.tools.review.objects import RevisionError
from cellc.tools.review.revisions import Repository

_SPEC = "cell.yaml"
_FEW = 4
_MADE_FROM = re.compile(r"\bcellc build ('[^']*'|[^\s`]+)")
_NAME = re.compile(rb"^cell:.*$", re.MULTILINE)
_READ = 4096
"""Bytes at the begin of a file that say what it is."""


def no_path(path: str, beside: str = "") -> str:
    """Say that there is no such file or folder, and what writes it.

    Args:
        beside: the other side, of which it may be the generated folder.
    """
    if Path(path).suffix:
        return f"there is no file or folder `{path}`"
    spec = quote(beside) if beside and Path(beside).is_file() else "SPEC"
    return f"there is no file or folder `{path}`; `cellc build {spec}` writes the folder of a cell"


def no_package(name: str, folder: Path) -> str:
    """Say that a folder is not that of one cell, and what to name instead."""
    inside = [f"`{name.rstrip('/')}/{each}`" for each in sorted(_named_in(folder))]
    more = f" and {len(inside) - _FEW} more" if len(inside) > _FEW else ""
    one = "one of " if len(inside) > 1 else ""
    wanted = f"{one}{', '.join(inside[:_FEW])}{more}" if inside else "the spec or the folder of one cell"
    return f"{name} has no `{MANIFEST}`: it is not a generated folder; name {wanted}"


def _named_in(folder: Path) -> Iterator[str]:
    if (folder / _SPEC).is_file():
        yield _SPEC
        return
    for below in folder.iterdir():
        if (below / MANIFEST).is_file():
            yield below.name
        elif (below / _SPEC).is_file():
            yield f"{below.name}/{_SPEC}"


def not_in_revision(repository: Repository, revision: str, path: str) -> str:
    """Return what to compare instead of a path that a revision does not have; empty where nothing is known.

    Args:
        path: from the top of the repository, with forward slashes.
    """
    here = repository.top.joinpath(*PurePosixPath(path).parts)
    if (here / MANIFEST).is_file():
        made = _MADE_FROM.search(_begin(here / "README.md").decode(errors="replace"))
        return (
            f"; where folders are not committed, compare specs: `cellc diff {revision} {made[1] if made else 'SPEC'}`"
        )
    if not here.is_file():
        return ""
    was = _moved_from(repository, revision, path, _begin(here))
    return (
        "; it is new there"
        if was is None
        else f", but `{was}`: `cellc diff {quote(f'{revision}:{was}')} {quote(path)}`"
    )


def _begin(file: Path) -> bytes:
    try:
        with open_regular(file) as opened:
            return opened.read(_READ)
    except OSError:
        return b""


def _moved_from(repository: Repository, revision: str, path: str, begin: bytes) -> str | None:
    """Return the only other spec of a revision that names the same cell."""
    name = _NAME.search(begin)
    try:
        tree = repository.objects.entry(repository.commit(revision), "")
        entries = () if tree is None else repository.objects.files(tree)
        specs = [each for each in entries if PurePosixPath(each.name).name == PurePosixPath(path).name]
        contents = repository.objects.contents(specs)
    except RevisionError:
        return None
    alike = [
        entry.name
        for entry, content in zip(specs, contents, strict=True)
        if name is not None and (found := _NAME.search(content[:_READ])) is not None and found[0] == name[0]
    ]
    return alike[0] if len(alike) == 1 else None
