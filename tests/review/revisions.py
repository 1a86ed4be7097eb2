"""A git repository with a cell in it, of which each test commits another edit."""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from cellc.contract.review import Review, ReviewChange
from cellc.tools.review.review import review
from cellc.tools.review.sides import Package, Side, packages
from tests.cells import spec_text

SPEC = "cells/ur5e_pick/cell.yaml"
SMALL = "cells/minimal/cell.yaml"
Edit = tuple[str, str]
"""A piece of the spec, which stands there once, and what it becomes."""


@dataclass(frozen=True)
class Repository:
    """A repository whose branch ``main`` holds the cell as it is in this repository."""

    folder: Path

    def git(self, *arguments: str) -> str:
        """Run git in it, with nothing of the machine's own settings."""
        of_nobody = {
            "GIT_CONFIG_GLOBAL": os.devnull,
            "GIT_CONFIG_NOSYSTEM": "1",
            **{f"GIT_{who}_{what}": "nobody" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")},
        }
        kept = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
        done = subprocess.run(
            ["git", *arguments], cwd=self.folder, env={**kept, **of_nobody}, check=True, capture_output=True, text=True
        )
        return done.stdout.strip()

    def write(self, text: str, path: str = SPEC) -> None:
        """Write a file of the work tree."""
        file = self.folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def commit(self, text: str, path: str = SPEC) -> str:
        """Commit a file on top of `main`, and return the id of the commit."""
        self.git("checkout", "-q", "--detach", "main")
        self.write(text, path)
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "edited")
        return self.git("rev-parse", "HEAD")


def new_repository(folder: Path, spec: str = SPEC) -> Repository:
    """Return a repository with a cell."""
    repository = Repository(folder)
    repository.git("init", "-q", "-b", "main")
    repository.write(spec_text(spec.split("/")[1]), spec)
    repository.git("add", "-A")
    repository.git("commit", "-q", "-m", "the cell")
    return repository


def edited(*edits: Edit, cell: str = "ur5e_pick") -> str:
    """Return the spec of a cell with edits."""
    text = spec_text(cell)
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def package_of(repository: Repository, revision: str) -> Package:
    """Return what the cell is in a revision."""
    with packages(Side(revision, SPEC, revision, repository.folder)) as ((package, _),):
        return package


def told(change: ReviewChange) -> str:
    """Return a change as tests write it."""
    values = f"{change.before} -> {change.after}"
    parts = (f"{change.grade} {change.area}", ", ".join(change.subjects), change.quantity, values, change.delta)
    return " | ".join(part for part in (*parts, "breaks" if change.breaking else "") if part)


def changes_of(before: Package, after: Package) -> list[str]:
    """Return the changes between two packages as tests write them."""
    return [told(change) for change in reviewed(before, after).changes]


def reviewed(before: Package, after: Package) -> Review:
    """Return the review of two packages."""
    return review(before, after)
