"""What git stores: the repository of a folder, and its objects, each checked against the id that it is asked for by.

The repository is found here and not by git, which takes a folder that looks like a bare one for a repository: a branch
may hold such a folder. Nothing that a repository configures is run: the commands below have no part in hooks, filters,
textconv, pagers, external diffs and transports, and what is left is turned off. Replaced objects, grafts and files that
git derives from commits would forge what a commit holds, and are not looked at.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from cellc.contract.errors import CellcError
from cellc.contract.limits import limits, option
from cellc.contract.store.regular_file import read_regular

_PATIENCE_S = 10
"""A pipe in the place of a file of a repository keeps git waiting."""
_GIT = (
    "git",
    "--no-pager",
    "-c",
    "safe.bareRepository=explicit",
    "-c",
    "core.fsmonitor=false",
    "-c",
    f"core.hooksPath={os.devnull}",
    "-c",
    "core.commitGraph=false",
    "-c",
    "protocol.allow=never",
)
_ENVIRONMENT = {
    "GIT_TERMINAL_PROMPT": "0",
    "GIT_OPTIONAL_LOCKS": "0",
    "GIT_NO_LAZY_FETCH": "1",
    "GIT_NO_REPLACE_OBJECTS": "1",
    "GIT_GRAFT_FILE": os.devnull,
    "LC_ALL": "C",
}
_TREE = "40000"
_SUBMODULE = b"160000 "
_LONGEST_POINTER = 4096
_DEEPEST = 64
"""Folders below each other."""


class RevisionError(CellcError):
    """git is absent, or does not know what was asked for; the text is one line."""


@dataclass(frozen=True, slots=True)
class Entry:
    """What a tree lists; ``name`` is its path from that tree down."""

    mode: str
    identity: str
    name: str


@dataclass(frozen=True, slots=True)
class Objects:
    """The objects of a repository.

    Args:
        top: the folder of its work tree, with every link followed.
        place: where git keeps it, which a file `.git` names in a submodule and in a further work tree.
    """

    top: Path
    place: str

    def ask(self, *arguments: str, given: bytes = b"") -> bytes | None:
        """Return what git says of the repository; None where it refuses."""
        return _asked(self.top, f"--git-dir={self.place}", f"--work-tree={self.top}", *arguments, given=given)

    def entry(self, commit: str, path: str) -> Entry | None:
        """Return what a commit has at a path, from the top, with forward slashes; None where it has nothing."""
        head, _, _ = self._read([commit], "commit")[0].partition(b"\n")
        current = Entry(_TREE, head.removeprefix(b"tree ").decode(), "")
        for part in path.split("/") if path not in ("", ".") else ():
            if current.mode != _TREE:
                return None
            listed = {
                entry.name: entry for entry in _listed(self._read([current.identity], "tree")[0], current.identity)
            }
            if part not in listed:
                return None
            current = listed[part]
        return current

    def files(self, tree: Entry) -> tuple[Entry, ...]:
        """Return everything below a tree that is no tree.

        Raises:
            RevisionError: there are more entries than are read.
        """
        entries: list[Entry] = []
        open_ = [tree] if tree.mode == _TREE else []
        while open_:
            if open_[0].name.count("/") >= _DEEPEST:
                raise RevisionError(f"a revision holds folders nested deeper than {_DEEPEST} levels")
            below: list[Entry] = []
            for above, content in zip(open_, self._read([entry.identity for entry in open_], "tree"), strict=True):
                start = f"{above.name}/" if above is not tree else ""
                for entry in _listed(content, above.identity):
                    listed = Entry(entry.mode, entry.identity, start + entry.name)
                    (below if entry.mode == _TREE else entries).append(listed)
                if len(entries) + len(below) > limits().folder_entries:
                    raise RevisionError(
                        f"a revision holds more than {limits().folder_entries} files; {option('folder-entries')}"
                    )
            open_ = below
        return tuple(entries)

    def contents(self, entries: Sequence[Entry]) -> list[bytes]:
        """Return what files hold.

        Raises:
            RevisionError: it is more than is read, or not what the revision has.
        """
        most = limits().mesh_bytes
        for entry, size in zip(entries, self._sizes([entry.identity for entry in entries]), strict=True):
            if size > most:
                raise RevisionError(f"`{entry.name}` is larger than {most} bytes; {option('mesh-bytes')}")
        return self._read([entry.identity for entry in entries], "blob")

    def _read(self, identities: Sequence[str], kind: str) -> list[bytes]:
        """Return objects of one kind, each as its id says."""
        if sum(self._sizes(identities)) > limits().folder_total_bytes:
            text = f"a revision holds more than {limits().folder_total_bytes} bytes"
            raise RevisionError(f"{text}; {option('folder-total-bytes')}")
        answer = self.ask("cat-file", "--batch", given=_lines(identities)) or b""
        read, at = list[bytes](), 0
        for identity in identities:
            start = answer.find(b"\n", at) + 1
            _, _, size = answer[at : max(start - 1, at)].rpartition(b" ")
            content = answer[start : start + int(size)] if start and size.isdigit() else b""
            if _identity(kind, content, identity) != identity:
                raise RevisionError(f"the repository has a damaged {kind} {identity}")
            read.append(content)
            at = start + len(content) + 1
        return read

    def _sizes(self, identities: Sequence[str]) -> list[int]:
        """Return the bytes of objects; 0 for one that is not there."""
        answers = (self.ask("cat-file", "--batch-check", given=_lines(identities)) or b"").splitlines()
        sizes = [line.rpartition(b" ")[2] for line in answers]
        return [int(size) if size.isdigit() else 0 for size in sizes]


def objects_of(folder: Path) -> Objects:
    """Return the repository that a folder belongs to: the outermost one that has files of it, else the nearest.

    A repository that somebody put into a folder of another one is not responsible for files that the other one has.

    Raises:
        RevisionError: it belongs to none, or git is not installed or does not trust it.
    """
    shown = folder.as_posix()
    folder = Path(os.path.realpath(folder))
    while not folder.is_dir() and folder != folder.parent:
        folder = folder.parent
    tops = [place for place in (folder, *folder.parents) if _begins_repository(place / ".git")]
    for outer in reversed(tops[1:]):
        objects = _opened(outer)
        if objects is not None and _has_files(objects, tops[0]):
            return objects
    objects = _opened(tops[0]) if tops else None
    if objects is None:
        raise RevisionError(f"`{shown}` is not in a readable Git repository")
    return objects


def _begins_repository(place: Path) -> bool:
    if place.is_dir():
        return os.path.lexists(place / "HEAD")
    try:
        return read_regular(place, _LONGEST_POINTER).startswith(b"gitdir: ")
    except OSError:
        return False


def _opened(top: Path) -> Objects | None:
    """Return the repository of a work tree; None where git finds none there, or trusts not who owns it."""
    folder = _asked(top, "rev-parse", "--absolute-git-dir", ceiling=top.parent)
    place = os.fsdecode((folder or b"").removesuffix(b"\n"))
    return Objects(top, place) if place and Path(place) != top else None


def _has_files(repository: Objects, folder: Path) -> bool:
    inside = folder.relative_to(repository.top).as_posix()
    listing = repository.ask("ls-files", "--stage", "-z", "--", f":(literal){inside}") or b""
    return any(not line.startswith(_SUBMODULE) for line in listing.split(b"\0")[:-1])


def _listed(tree: bytes, identity: str) -> Iterator[Entry]:
    """Yield the entries of a tree: mode, space, name, a zero, and the id as bytes."""
    length, at = len(identity) // 2, 0
    while at < len(tree):
        end = tree.find(b"\0", at)
        mode, _, name = tree[at : max(end, at)].partition(b" ")
        at = end + 1 + length
        if end < 0 or at > len(tree) or not mode.isdigit():
            raise RevisionError(f"the repository holds a tree {identity} that is not well formed")
        yield Entry(mode.decode(), tree[end + 1 : at].hex(), os.fsdecode(name))


def _identity(kind: str, content: bytes, like: str) -> str:
    digest = hashlib.sha1(usedforsecurity=False) if len(like) == 40 else hashlib.sha256()
    digest.update(f"{kind} {len(content)}\0".encode() + content)
    return digest.hexdigest()


def _lines(identities: Sequence[str]) -> bytes:
    return "".join(f"{identity}\n" for identity in identities).encode()


def _asked(folder: Path, *arguments: str, given: bytes = b"", ceiling: Path | None = None) -> bytes | None:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    bounded = {} if ceiling is None else {"GIT_CEILING_DIRECTORIES": str(ceiling)}
    try:
        done = subprocess.run(
            [*_GIT, *arguments],
            cwd=folder,
            env={**environment, **_ENVIRONMENT, **bounded},
            input=given,
            capture_output=True,
            check=False,
            timeout=_PATIENCE_S,
        )
    except FileNotFoundError:
        raise RevisionError("revisions need git, which is not installed") from None
    except subprocess.TimeoutExpired:
        raise RevisionError(f"git must answer within {_PATIENCE_S} s; look for a pipe below `.git`") from None
    except (OSError, ValueError):  # ValueError: a zero character in an argument
        raise RevisionError(f"git did not answer `{arguments[-1]}`") from None
    return done.stdout if done.returncode == 0 else None
