"""The evidence folder: made ready beside its place, then put there in one step; files of others stay."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import BinaryIO
from urllib.parse import quote

from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.errors import reason_of
from cellc.contract.file_names import is_file_name, opens_a_device
from cellc.contract.limits import limits, option
from cellc.contract.store.regular_file import open_regular, read_regular
from cellc.contract.store.staging import contested, discard, make_staging, others, staging_of
from cellc.contract.store.swap import Swap, link_on_the_way, make_folder, open_new
from cellc.mock.errors import MockError

_LONGEST = 100

INDEX = "evidence.json"
"""Names every file of the folder with its hash, by which the next call tells its own files from those of others."""
_PIECE = 1 << 20


def file_names(rehearsals: Iterable[str]) -> dict[str, str]:
    """Return the stem of the files of each rehearsal: its name where every file system takes it.

    Other characters are escaped as in a URL; names that are one where case does not count get a number.
    """
    stems: dict[str, str] = {}
    taken = {"report", "evidence"}
    for name in rehearsals:
        if name in stems:
            continue
        plain = quote(name, safe=" ")[:_LONGEST].replace("~", "%7E").strip(" ")
        plain = f"_{plain}" if not plain or plain.startswith(".") or opens_a_device(plain) else plain
        stem, number = plain, 2
        while stem.casefold() in taken:
            stem, number = f"{plain}-{number}", number + 1
        taken.add(stem.casefold())
        stems[name] = stem
    return stems


class EvidenceFolder:
    """Takes files one by one; none is in its place before `settle`."""

    def __init__(self, folder: Path, names: Sequence[str]) -> None:
        """Make ready.

        Args:
            names: of the files that will be written.

        Raises:
            MockError: something is in the way, or another run writes the same folder.
        """
        self._folder = folder
        self._staging = staging_of(folder)
        self._names: list[str] = []
        is_linked = folder.is_symlink() or link_on_the_way(folder) is not None
        no_folder = is_linked or (folder.exists() and not folder.is_dir())
        if no_folder or not Path(os.path.abspath(folder)).name:
            raise MockError(folder.as_posix(), "is not a folder that evidence can be written to")
        self._stale = others(folder)
        if contested(folder):
            raise MockError(folder.as_posix(), _BUSY)
        self._refuse_edited(names)
        try:
            make_folder(folder.parent)
            make_staging(folder)  # fails where anything is there, a link too
            make_folder(self._staging / "new")
        except BlockingIOError:
            raise MockError(folder.as_posix(), _BUSY) from None
        except OSError as error:
            raise self._unwritable(error) from None
        if contested(folder):  # by one that began at the same moment
            self.discard()
            raise MockError(folder.as_posix(), _BUSY)

    def open(self, name: str) -> BinaryIO:
        """Open a new file of the folder for writing; a name of one part, as `file_names` gives them."""
        self._names.append(name)
        return open_new(self._staging / "new" / name)

    def write(self, name: str, text: str) -> None:
        """Write a whole file."""
        with self.open(name) as file:
            file.write(text.encode())

    def settle(self, identity: Mapping[str, str | int]) -> None:
        """Put all files in their place, the index last, and remove what an earlier call wrote and this one did not.

        Args:
            identity: is in the index before the hashes.

        Raises:
            MockError: a file was edited meanwhile, or the disk refused; the folder is as it was before.
        """
        self._refuse_edited(self._names)
        new = self._staging / "new"
        hashes = {name: _sha256(new / name) for name in sorted(self._names)}
        self.write(INDEX, json_document({"format": 1, **identity, "files": hashes}))
        former = {*_hashes(self._folder), *(name for staging in self._stale for name in _hashes(staging / "new"))}
        try:
            self._swap(sorted(former - set(hashes) - {INDEX}), [*hashes, INDEX])
        except OSError as error:
            raise self._unwritable(error) from None
        for staging in self._stale:
            discard(staging)

    def discard(self) -> None:
        """Remove what is in no place yet."""
        discard(self._staging)

    def _refuse_edited(self, names: Sequence[str]) -> None:
        """Raise MockError where there is a file that would be replaced and that cellc did not write."""
        known = [_hashes(self._folder), *(_hashes(staging / "new") for staging in self._stale)]
        most = left = limits().folder_total_bytes
        for name in sorted({*names, *(name for hashes in known for name in hashes)} - {INDEX}):
            path = self._folder / name
            if path.is_symlink() or (path.exists() and not path.is_file()):
                raise MockError(path.as_posix(), "must be a file: evidence is written there")
            left -= path.stat().st_size if path.exists() else 0
            if left < 0:  # a name in an index, and a file without content on the disk, cost an attacker nothing
                raise MockError(path.as_posix(), f"exceeds {most} bytes of evidence; {option('folder-total-bytes')}")
            digest = _sha256(path) if path.exists() else ""
            if digest and all(hashes.get(name) != digest for hashes in known):
                raise MockError(path.as_posix(), "is not as cellc wrote it; move it away, or name another folder")
        index = self._folder / INDEX
        if index.is_symlink() or (index.exists() and not _is_index(index)):
            raise MockError(index.as_posix(), "is no index of evidence; move it away, or name another folder")

    def _swap(self, removed: Sequence[str], put: Sequence[str]) -> None:
        swap = Swap(self._folder, self._staging)
        try:
            for name in put:
                _flush(self._staging / "new" / name)
            swap.make_folder(self._folder)
            for name in removed:
                if (self._folder / name).is_file():
                    swap.remove(name)
            for name in put:
                swap.put(name)
            swap.settle()
        except BaseException:  # Ctrl-C too: what was replaced is put back
            swap.undo()
            raise

    def _unwritable(self, error: OSError) -> MockError:
        return MockError(self._folder.as_posix(), f"cannot be written: {reason_of(error)}")


def _is_index(path: Path) -> bool:
    try:
        return isinstance(json.loads(read_regular(path, limits().folder_bytes))["files"], dict)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False


def _hashes(folder: Path) -> dict[str, str]:
    """Return the hashes of an index; an index is data that others may have written, so that it names no other place."""
    try:
        files = json.loads(read_regular(folder / INDEX, limits().folder_bytes, follow=False))["files"]
        return {name: str(sha256) for name, sha256 in files.items() if is_file_name(name)}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def _sha256(path: Path) -> str:
    digest = hashlib.sha256()
    with open_regular(path, follow=False) as file:
        while piece := file.read(_PIECE):
            digest.update(piece)
    return digest.hexdigest()


def _flush(path: Path) -> None:
    with open_regular(path, follow=False) as file:
        os.fsync(file.fileno())


_BUSY = "another run is writing its evidence there"
