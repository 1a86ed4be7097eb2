"""Files of a git revision in a private folder; the repository is only read.

Names of revisions and paths are arguments, never words of a shell. Variables `GIT_*` of who calls, such as those of a
hook, do not choose another repository.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from cellc.contract.errors import reason_of
from cellc.contract.store.swap import make_folder, temporary_folder, write_new
from cellc.tools.review.objects import Entry, Objects, RevisionError, objects_of

_FILES = ("100644", "100755", "100664")
_LINK = "120000"
_NAMING = (".yaml", ".yml", ".xacro", ".urdf")
"""Files that name others by their path."""


@dataclass(frozen=True, slots=True)
class Repository:
    """A repository, by the names of its revisions."""

    objects: Objects

    @property
    def top(self) -> Path:
        """The folder of its work tree."""
        return self.objects.top

    def commit(self, revision: str) -> str:
        """Return the id of a commit.

        Raises:
            RevisionError: no commit has that name.
        """
        if not revision or revision.startswith("-"):
            raise RevisionError(f"`{revision}` is not a revision")
        identity = self.objects.ask("rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
        if identity is None:
            raise RevisionError(f"there is no revision `{revision}`")
        return identity.decode().split()[-1]

    def merge_base(self, one: str, other: str) -> str:
        """Return the commit that two revisions have in common.

        Raises:
            RevisionError: they have no commit in common.
        """
        identity = self.objects.ask("merge-base", self.commit(one), self.commit(other))
        if identity is None:
            raise RevisionError(f"`{one}` and `{other}` have no commit in common")
        return identity.decode().split()[0]

    @contextmanager
    def taken(self, revision: str, path: str) -> Iterator[Taken]:
        """Give a path of a revision with its folder, or the folder itself, in a folder that is removed afterwards.

        Where a file of that folder leads out of it, all of the revision is taken: what is named lies beside it.

        Args:
            path: from the top of the repository, with forward slashes.

        Raises:
            RevisionError: the revision has no such file or folder, or more of it than is read.
        """
        commit = self.commit(revision)
        asked = self.objects.entry(commit, path)
        if asked is None:
            raise RevisionError(f"revision `{revision}` has no `{path}`")
        is_folder = asked.mode not in (*_FILES, _LINK)
        name = PurePosixPath(path).name
        folder = path if is_folder else PurePosixPath(path).parent.as_posix()
        if asked.mode == _LINK:
            raise RevisionError(f"`{revision}:{path}` is a link, which is not followed")
        entries = self._entries(commit, folder, revision)
        files = self._files(entries)
        with temporary_folder("cellc-diff-") as top:
            place = top
            if folder != "." and any(_leads_out(name, content) for name, content in files.items()):
                entries = self._entries(commit, "", revision)
                files, place = self._files(entries), Path(top, *PurePosixPath(folder).parts)
                make_folder(top / ".git")  # where the repository ends, and with it what a spec may name
            _lay_out(files, top, revision)
            yield Taken(place if is_folder else place / name, place, top, len(entries) - len(files))

    def _entries(self, commit: str, folder: str, revision: str) -> tuple[Entry, ...]:
        tree = self.objects.entry(commit, folder)
        entries = () if tree is None else self.objects.files(tree)
        for entry in entries:
            parts = PurePosixPath(entry.name).parts
            if PurePosixPath(entry.name).is_absolute() or not {"..", ".git"}.isdisjoint(parts) or "\\" in entry.name:
                place = f"{revision}:{folder}"
                raise RevisionError(f"`{place}` holds the name {entry.name!a}, which is not a path inside a folder")
        return entries

    def _files(self, entries: Sequence[Entry]) -> dict[str, bytes]:
        regular = [entry for entry in entries if entry.mode in _FILES]
        return {entry.name: content for entry, content in zip(regular, self.objects.contents(regular), strict=True)}


@dataclass(frozen=True, slots=True)
class Taken:
    """What was taken out of a revision.

    Attributes:
        path: what was asked for.
        folder: that it is in, or is.
        top: the private folder; that of the whole repository where all of it was taken, else ``folder``.
        links: how many were left out.
    """

    path: Path
    folder: Path
    top: Path
    links: int


def repository_of(folder: Path) -> Repository:
    """Return the repository that a folder belongs to.

    Raises:
        RevisionError: it belongs to none, or git is not installed.
    """
    return Repository(objects_of(folder))


def _lay_out(files: Mapping[str, bytes], top: Path, revision: str) -> None:
    name = ""
    try:
        for name, content in files.items():
            write_new(Path(top, *PurePosixPath(name).parts), content)
    except OSError as error:
        raise RevisionError(f"`{revision}` holds {name!a}, which cannot be laid out: {reason_of(error)}") from None


def _leads_out(name: str, content: bytes) -> bool:
    if PurePosixPath(name).suffix not in _NAMING or b"../" not in content:
        return False
    return any(b"../" in line.partition(b"#")[0] for line in content.splitlines())  # an editor's schema is a comment
