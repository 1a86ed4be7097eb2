"""Files of a git revision in a private folder; the repository is only read, and nothing that it configures is run.

Objects are read as they are stored (`git ls-tree`, `git cat-file`): no hook, filter, textconv, pager or external diff
has a part in that. Names of revisions and paths are arguments, never words of a shell. Variables `GIT_*` of who calls,
such as those of a hook, do not choose another repository.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from cellc.limits import limits, option

_PATIENCE_S = 120
_GIT = (
    "git",
    "--no-pager",
    "-c",
    "core.fsmonitor=false",
    "-c",
    f"core.hooksPath={os.devnull}",
    "-c",
    "protocol.allow=never",
)
_ENVIRONMENT = {"GIT_TERMINAL_PROMPT": "0", "GIT_OPTIONAL_LOCKS": "0", "GIT_NO_LAZY_FETCH": "1", "LC_ALL": "C"}
_FILES = ("100644", "100755")
_NAMING = (".yaml", ".yml", ".xacro", ".urdf")
"""Files that name others by their path."""


class RevisionError(Exception):
    """git is absent, or does not know what was asked for; the text is one line."""


@dataclass(frozen=True, slots=True)
class Repository:
    """A repository; ``top`` is the folder of its work tree."""

    top: Path

    def commit(self, revision: str) -> str:
        """Return the id of a commit.

        Raises:
            RevisionError: there is none of that name.
        """
        if not revision or revision.startswith("-"):
            raise RevisionError(f"`{revision}` is no revision")
        found = _asked(self.top, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
        if found is None:
            raise RevisionError(f"there is no revision `{revision}`")
        return found.decode().split()[-1]

    def merge_base(self, one: str, other: str) -> str:
        """Return the commit that two revisions have in common.

        Raises:
            RevisionError: there is none.
        """
        found = _asked(self.top, "merge-base", self.commit(one), self.commit(other))
        if found is None:
            raise RevisionError(f"`{one}` and `{other}` have no commit in common")
        return found.decode().split()[0]

    @contextmanager
    def taken(self, revision: str, path: str) -> Iterator[Taken]:
        """Give a path of a revision with the folder that it stands in, or is, in a folder that is removed afterwards.

        Where a file of that folder leads out of it, all of the revision is taken: what is named lies beside it.

        Args:
            path: from the top of the repository, with forward slashes.

        Raises:
            RevisionError: the revision has no such file or folder, or more of it than is read.
        """
        commit = self.commit(revision)
        kind = _asked(self.top, "cat-file", "-t", f"{commit}:{path}")
        if kind is None:
            raise RevisionError(f"revision `{revision}` has no `{path}`")
        is_folder = kind == b"tree\n"
        folder = path if is_folder else PurePosixPath(path).parent.as_posix()
        entries = tuple(self._entries(f"{commit}:{'' if folder == '.' else folder}"))
        name = PurePosixPath(path).name
        if not is_folder and name not in {entry.name for entry in entries if entry.mode in _FILES}:
            raise RevisionError(f"`{revision}:{path}` is a link, which is not followed")
        _refuse_too_much(f"{revision}:{folder}", entries)
        files = self._files(entries)
        with tempfile.TemporaryDirectory(prefix="cellc-diff-") as private:
            place = top = Path(private)
            if folder != "." and any(_leads_out(name, content) for name, content in files.items()):
                entries = tuple(self._entries(f"{commit}:"))
                _refuse_too_much(f"{revision}:", entries)
                files, place = self._files(entries), Path(top, *PurePosixPath(folder).parts)
                (top / ".git").mkdir()  # where the repository ends, and with it what a spec may name
            for inside, content in files.items():
                target = Path(top, *PurePosixPath(inside).parts)
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)
            yield Taken(place if is_folder else place / name, place, top, len(entries) - len(files))

    def _files(self, entries: Sequence[_Entry]) -> dict[str, bytes]:
        kept = [entry for entry in entries if entry.mode in _FILES]
        return {entry.name: content for entry, content in zip(kept, self._contents(kept), strict=True)}

    def _entries(self, tree: str) -> Iterator[_Entry]:
        found = _asked(self.top, "ls-tree", "-r", "-z", "-l", "--full-tree", tree)
        for line in (found or b"").split(b"\0")[:-1]:
            facts, _, name = line.partition(b"\t")
            mode, _, identity, size = facts.split()
            yield _Entry(mode.decode(), identity.decode(), int(size) if size.isdigit() else 0, os.fsdecode(name))

    def _contents(self, entries: Sequence[_Entry]) -> Iterator[bytes]:
        asked = "".join(f"{entry.identity}\n" for entry in entries).encode()
        found = _asked(self.top, "cat-file", "--batch", given=asked) or b""
        at = 0
        for entry in entries:
            start = found.index(b"\n", at) + 1
            if not found[at:start].endswith(f" {entry.size}\n".encode()):
                raise RevisionError(f"`{entry.name}` is not in the repository as the revision has it")
            yield found[start : start + entry.size]
            at = start + entry.size + 1


@dataclass(frozen=True, slots=True)
class Taken:
    """What was taken out of a revision.

    Attributes:
        path: what was asked for.
        folder: that it stands in, or is.
        top: the private folder; that of the whole repository where all of it was taken, else ``folder``.
        links: how many were left out.
    """

    path: Path
    folder: Path
    top: Path
    links: int


@dataclass(frozen=True, slots=True)
class _Entry:
    mode: str
    identity: str
    size: int
    name: str


def repository_of(folder: Path) -> Repository:
    """Return the repository that a folder belongs to.

    Raises:
        RevisionError: it belongs to none, or git is not installed.
    """
    while not folder.is_dir() and folder != folder.parent:
        folder = folder.parent
    found = _asked(folder, "rev-parse", "--show-toplevel")
    if found is None:
        raise RevisionError(f"`{folder.as_posix()}` is in no git repository that may be read")
    return Repository(Path(os.fsdecode(found.removesuffix(b"\n"))))


def _leads_out(name: str, content: bytes) -> bool:
    if PurePosixPath(name).suffix not in _NAMING or b"../" not in content:
        return False
    return any(b"../" in line.partition(b"#")[0] for line in content.splitlines())  # an editor's schema is a comment


def _refuse_too_much(shown: str, entries: Sequence[_Entry]) -> None:
    most = limits()
    for entry in entries:
        parts = PurePosixPath(entry.name).parts
        if PurePosixPath(entry.name).is_absolute() or not {"..", ".git"}.isdisjoint(parts) or "\\" in entry.name:
            raise RevisionError(f"`{shown}` holds the name {entry.name!a}, which is no path inside a folder")
        if entry.size > most.mesh_bytes:
            raise RevisionError(f"`{entry.name}` is larger than {most.mesh_bytes} bytes; {option('mesh-bytes')}")
    if len(entries) > most.folder_entries:
        text = f"`{shown}` holds {len(entries)} files, at most {most.folder_entries} are taken"
        raise RevisionError(f"{text}; {option('folder-entries')}")
    if sum(entry.size for entry in entries) > most.folder_total_bytes:
        text = f"`{shown}` holds more than {most.folder_total_bytes} bytes"
        raise RevisionError(f"{text}; {option('folder-total-bytes')}")


def _asked(folder: Path, *arguments: str, given: bytes = b"") -> bytes | None:
    """Return what git says; None where it refuses."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    try:
        done = subprocess.run(
            [*_GIT, *arguments],
            cwd=folder,
            env={**kept, **_ENVIRONMENT},
            input=given,
            capture_output=True,
            check=False,
            timeout=_PATIENCE_S,
        )
    except FileNotFoundError:
        raise RevisionError("git is not installed, which reads revisions") from None
    except (subprocess.TimeoutExpired, OSError, ValueError):  # ValueError: a zero character in an argument
        raise RevisionError(f"git did not answer `{arguments[0]}`") from None
    return done.stdout if done.returncode == 0 else None
