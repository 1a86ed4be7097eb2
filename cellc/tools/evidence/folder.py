"""What is in a folder of evidence: files and bags, and what is not read, each with why. No link is followed."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel

from cellc.contract.errors import CellcError, reason_of
from cellc.contract.file_names import is_file_name
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits, option
from cellc.contract.reading import FormatError, read_json
from cellc.contract.store.regular_file import FileTooLargeError, read_regular

_DEPTH = 8
_METADATA = "metadata.yaml"
_READ = (".json", ".md", ".txt")
"""Ends of the names of files that are read."""
_Model = TypeVar("_Model", bound=BaseModel)


class EvidenceError(CellcError):
    """A folder or a package cannot be used, or a file of evidence cannot be read; the text says why, in one line."""


@dataclass(frozen=True, slots=True)
class Item:
    """A file, or a bag as a whole; `path` is relative to the folder, with forward slashes, `size` in bytes."""

    path: str
    place: Path
    is_bag: bool = False
    size: int = 0

    @property
    def name(self) -> str:
        """The last part of its path."""
        return self.place.name

    def text(self) -> str:
        """Return what it holds.

        Raises:
            EvidenceError: it is too large, no text in UTF-8, or cannot be read.
        """
        try:
            return read_regular(self.place, limits().folder_bytes, follow=False).decode("utf-8")
        except FileTooLargeError as error:
            raise EvidenceError(f"{error.strerror}; {option('folder-bytes')}") from None
        except OSError as error:
            raise EvidenceError(f"cannot be read: {reason_of(error)}") from None
        except UnicodeDecodeError:
            raise EvidenceError("must be text in UTF-8") from None

    def record(self, model: type[_Model]) -> _Model:
        """Return a record in JSON; raise EvidenceError where it is not one."""
        try:
            return read_json(self.text(), model)
        except FormatError as error:
            raise EvidenceError(str(error)) from None


@dataclass(frozen=True, slots=True)
class Unread:
    """What is in the folder and was not read."""

    path: str
    why: str


def listed(folder: Path, bags: Collection[str]) -> tuple[tuple[Item, ...], tuple[Unread, ...]]:
    """Return what is in a folder and in those below it, in order, and what is not read.

    Args:
        bags: names of folders that gates record into.

    Raises:
        EvidenceError: it is no folder.
    """
    if not folder.is_dir():
        raise EvidenceError(f"{folder.as_posix()}: {'is not a folder' if folder.exists() else 'no such folder'}")
    most, left, items, unread = limits().folder_entries, limits().folder_total_bytes, list[Item](), list[Unread]()
    for number, found in enumerate(_below(folder, "", bags, _DEPTH)):
        if number >= most:
            unread.append(
                Unread(".", f"holds more than {most} files, the rest is not read; {option('folder-entries')}")
            )
            break
        left -= found.size if isinstance(found, Item) and found.name.endswith(_READ) else 0
        if isinstance(found, Unread):
            unread.append(found)
        elif left < 0:
            unread.append(Unread(found.path, f"exceeds what is read of a folder; {option('folder-total-bytes')}"))
        else:
            items.append(found)
    return tuple(items), tuple(unread)


def _below(folder: Path, above: str, bags: Collection[str], depth: int) -> Iterator[Item | Unread]:
    try:
        with os.scandir(folder) as entries:
            found = sorted(entries, key=lambda entry: entry.name)
    except OSError as error:
        yield Unread(above.rstrip("/") or ".", f"cannot be read: {reason_of(error)}")
        return
    for entry in found:
        path, place = f"{above}{entry.name}", folder / entry.name
        if not is_file_name(entry.name):
            yield Unread(path, "must have a name of printable characters")
        elif entry.is_symlink():
            yield Unread(path, "is a symbolic link, which is not followed; copy the file itself")
        elif entry.is_file(follow_symlinks=False):
            yield Item(path, place, size=entry.stat(follow_symlinks=False).st_size)
        elif not entry.is_dir(follow_symlinks=False):
            yield Unread(path, "must be a file or a folder")
        elif entry.name in bags or os.path.lexists(place / _METADATA):
            yield Item(path, place, is_bag=True)
        elif depth == 1:
            yield Unread(path, f"is deeper than {_DEPTH} folders")
        else:
            yield from _below(place, f"{path}/", bags, depth - 1)


def metadata_of(bag: Item) -> str:
    """Return what rosbag2 writes at the end of a recording; raise EvidenceError where it has not."""
    place = bag.place / _METADATA
    if not os.path.lexists(place):
        raise EvidenceError(f"has no {_METADATA}: the recording was not ended with Ctrl-C")
    return Item(f"{bag.path}/{_METADATA}", place).text()
