"""The one reader: every file that cellc reads is opened here, and a test holds it.

Anybody may have put the file there: nothing is waited for, and no more is read than may be.
"""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO


class FileTooLargeError(OSError):
    """A file holds more than may be read."""


class NotRegularError(OSError):
    """What is in the place of a file is a pipe, a device, a socket or a folder."""


def open_regular(path: Path, *, follow: bool = True) -> BinaryIO:
    """Open a regular file for reading; a pipe in its place is not waited for, and a device is not read.

    Args:
        follow: whether the name may be a symbolic link.

    Raises:
        NotRegularError: it is something else.
        OSError: the file does not exist, or cannot be read.
    """
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    descriptor = os.open(path, flags if follow else flags | getattr(os, "O_NOFOLLOW", 0))
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise NotRegularError(errno.EINVAL, "Not a regular file")
    return os.fdopen(descriptor, "rb")


def read_regular(path: Path, most: int, *, follow: bool = True) -> bytes:
    """Return what a regular file holds.

    Args:
        most: bytes that it may hold.

    Raises:
        FileTooLargeError: it holds more.
        OSError: as `open_regular`.
    """
    with open_regular(path, follow=follow) as stream:
        content = stream.read(most + 1)
    if len(content) > most:
        raise FileTooLargeError(errno.EFBIG, f"is larger than {most} bytes")
    return content


def own_bytes(file: Path) -> bytes:
    """Return what a file holds that is installed with cellc or its libraries: it is as large as it is."""
    return file.read_bytes()


def own_text(file: Path) -> str:
    """Return the same as text."""
    return own_bytes(file).decode("utf-8")
