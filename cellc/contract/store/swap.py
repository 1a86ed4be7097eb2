"""The one writer: whatever cellc writes, makes, moves or removes goes through here, and a test holds it.

Files are put in place immediately or not at all: those of a folder, or one.

New files are made ready in a staging folder beside it, then moved; or every old file is put back.
"""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import BinaryIO

from cellc.contract.store.regular_file import open_regular
from cellc.contract.store.staging import discard, runs, staging_of, temporaries


@dataclass
class Swap:
    """Replaces files of a folder one by one; each replacement is atomic, so that no reader sees half a file.

    Each step is noted before it is taken, so that `undo` is right wherever an interrupt falls.

    Args:
        folder: the output folder.
        staging: holds new files below ``new``; old ones are kept below ``old``.
    """

    folder: Path
    staging: Path
    _changed: list[str] = field(default_factory=list)
    _absent: set[str] = field(default_factory=set)
    _made: list[Path] = field(default_factory=list)

    def put(self, path: str) -> None:
        """Move a new file into its place."""
        self._keep(path)
        self.make_folder((self.folder / path).parent)
        os.replace(self.staging / "new" / path, self.folder / path)

    def remove(self, path: str) -> None:
        """Take a file away."""
        self._keep(path)
        os.unlink(self.folder / path)

    def make_folder(self, folder: Path) -> None:
        """Make a folder and those above it."""
        if folder.is_dir():
            return
        self.make_folder(folder.parent)
        self._made.append(folder)
        try:
            os.mkdir(folder)
        except FileExistsError:
            self._made.pop()
            if not folder.is_dir():  # another process made it meanwhile
                raise

    def settle(self) -> None:
        """Have the system put the names of the changed files on the disk, before the old files are let go."""
        for folder in sorted({(self.folder / path).parent for path in self._changed}):
            if os.name != "posix" or not folder.is_dir():
                continue
            descriptor = os.open(folder, os.O_RDONLY)
            try:
                os.fsync(descriptor)
            finally:
                os.close(descriptor)

    def undo(self) -> None:
        """Put back what was there, the same files with the same times, and remove what was not."""
        for path in reversed(self._changed):
            backup = self.staging / "old" / path
            if path in self._absent:
                (self.folder / path).unlink(missing_ok=True)
            elif backup.exists():
                os.replace(backup, self.folder / path)
        # All that was kept is back in its place; the staging folder would hold the folder that was made around it.
        discard(self.staging)
        for folder in reversed(self._made):
            # One that holds a file of somebody else by now stays, and what ended the build gets, not this.
            with contextlib.suppress(OSError):
                folder.rmdir()

    def _keep(self, path: str) -> None:
        linked = link_above(path, self.folder)
        if linked is not None:
            raise OSError(errno.ELOOP, "is a symbolic link", str(linked))
        here, backup = self.folder / path, self.staging / "old" / path
        if not os.path.lexists(here):
            self._absent.add(path)
            self._changed.append(path)
            return
        backup.parent.mkdir(parents=True, exist_ok=True)
        self._changed.append(path)
        try:
            os.link(here, backup)
        except OSError:  # a file system without hard links
            shutil.copy2(here, backup)


def link_above(path: str, folder: Path) -> Path | None:
    """Return the link on the way from a folder to a path in it, which may lead anywhere, or None."""
    parents = (folder / parent for parent in reversed(PurePosixPath(path).parents) if parent.parts)
    return next((place for place in parents if place.is_symlink()), None)


def link_on_the_way(place: Path) -> Path | None:
    """Return a link that the way to a place takes below the current folder: there it may be untrusted."""
    here = Path.cwd()
    below = (item for item in (place, *place.parents) if not item.is_absolute() or here in item.parents)
    return next((item for item in below if item.is_symlink()), None)


def write_whole(file: Path, text: str) -> None:
    """Write a text; a reader sees the old file or the new one, and a failure leaves nothing behind.

    Raises:
        OSError: a link is at the file or its folder, the disk is full, or writing is refused; it names the place.
    """
    linked = file.parent if file.parent.is_symlink() else link_on_the_way(file)
    linked = file if file.is_symlink() else linked
    if linked is not None:  # as builds do: a link of somebody else's leads anywhere
        raise OSError(errno.ELOOP, "is a symbolic link; name the place itself", str(linked))
    try:
        make_folder(file.parent)
        replace_whole(file, text.encode())
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(file)) from error


def replace_whole(file: Path, content: bytes, mode: int = 0o666) -> None:
    """Put a new file in the place of a name; where the name is a link, the link goes and its target stays.

    Args:
        mode: who may do what with it, as far as the user's umask lets.

    Raises:
        OSError: the disk is full, or writing is refused.
    """
    part = staging_of(file)
    for left in temporaries(file):
        if not runs(left):
            remove_file(left)  # what a killed process left; of a link, the link alone
    try:
        with open_new(part, mode) as stream:
            stream.write(content)
        os.replace(part, file)
    finally:
        remove_file(part)


def replace_content(file: Path, content: bytes) -> None:
    """Replace the content of a user's file, whose permissions stay; a link keeps leading to its file.

    A reader sees the old or the new file, never a part. A file of several names (hard links) must stay one file: it is
    written in its place, and a copy of what it held lies beside it until the new content is on the disk.

    Raises:
        OSError: the folder cannot be written; the file is as it was.
    """
    real = file.resolve()
    descriptor, name = tempfile.mkstemp(prefix=f".{real.name}.", suffix=".cellc", dir=real.parent)
    copy = Path(name)
    shared = real.stat().st_nlink > 1
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(_held_by(real) if shared else content)
            stream.flush()
            os.fsync(stream.fileno())
        shutil.copymode(real, copy)
        if shared:
            _overwrite(real, content, copy)
        else:
            os.replace(copy, real)
    finally:
        remove_file(copy)


def _overwrite(file: Path, content: bytes, copy: Path) -> None:
    try:
        _write_over(file, content)
    except BaseException:
        _write_over(file, _held_by(copy))
        raise


def _held_by(file: Path) -> bytes:
    with open_regular(file, follow=False) as stream:
        return stream.read()


def _write_over(file: Path, content: bytes) -> None:
    with file.open("r+b") as stream:
        stream.write(content)
        stream.truncate()
        stream.flush()
        os.fsync(stream.fileno())


def write_new(file: Path, content: bytes, *, executable: bool = False, durable: bool = False) -> None:
    """Write a file that is not there yet, with the folders above it.

    Args:
        durable: have the system put it on the disk.

    Raises:
        OSError: something is there, the disk is full, or writing is refused.
    """
    make_folder(file.parent)
    with open_new(file) as stream:
        stream.write(content)
        if durable:
            stream.flush()
            os.fsync(stream.fileno())
    if executable:
        mode = file.stat().st_mode
        file.chmod(mode | (mode & 0o444) >> 2)


def open_new(file: Path, mode: int = 0o666) -> BinaryIO:
    """Open a new file for writing: never one that is there already, nor one behind a link.

    Raises:
        OSError: something is there, or writing is refused.
    """
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    return os.fdopen(os.open(file, flags, mode), "wb")


def open_to_continue(file: Path, kept: int) -> BinaryIO:
    """Open a file for writing behind its first bytes, and cut off the others; it is made where it is absent.

    Raises:
        OSError: a link is there, or writing is refused.
    """
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0) | getattr(os, "O_NOFOLLOW", 0)
    stream = os.fdopen(os.open(file, flags, 0o666), "r+b")
    stream.truncate(kept)
    stream.seek(kept)
    return stream


def open_stream(place: Path | int) -> BinaryIO:
    """Open a pipe or device of the user's, or an open descriptor again, for writing at its end."""
    return os.fdopen(os.dup(place), "wb") if isinstance(place, int) else place.open("ab")


def make_folder(folder: Path, mode: int = 0o777) -> None:
    """Make a folder, which may be there already, and those above it.

    Raises:
        OSError: writing is refused.
    """
    folder.mkdir(mode, parents=True, exist_ok=True)


def remove_folder(folder: Path) -> None:
    """Remove an empty folder.

    Raises:
        OSError: it is not empty, or writing is refused.
    """
    folder.rmdir()


def remove_file(file: Path) -> None:
    """Remove a file or a link as far as the system lets."""
    with contextlib.suppress(OSError):
        file.unlink()


@contextlib.contextmanager
def temporary_folder(prefix: str) -> Iterator[Path]:
    """Give a private folder of the system's for temporary files; it is removed afterwards."""
    with tempfile.TemporaryDirectory(prefix=prefix) as name:
        yield Path(name)


@contextlib.contextmanager
def temporary_file() -> Iterator[BinaryIO]:
    """Give a file without a name, which is gone afterwards."""
    with tempfile.TemporaryFile() as file:
        yield file
