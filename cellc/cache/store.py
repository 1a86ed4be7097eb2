"""Entries of the cache as files: packed, put in place in one step, checked when read, and never very many."""

from __future__ import annotations

import hashlib
import os
import tempfile
import zlib
from pathlib import Path

from cellc.cache.folder import cache_folder

MAX_BYTES = 10_000_000
"""A larger entry is not one that cellc wrote."""

MAX_ENTRIES = 2000
"""Entries of one kind; when there are more, the older half goes."""


def read_entry(name: str) -> bytes | None:
    """Return the content of an entry, or None where there is none, or it is not as this user wrote it."""
    folder = cache_folder()
    if folder is None:
        return None
    file = folder / name
    try:
        status = file.stat()
        # In a folder that several users share, nobody takes the answer of another.
        if status.st_size > MAX_BYTES or (hasattr(os, "getuid") and status.st_uid != os.getuid()):
            return None
        digest, _, packed = file.read_bytes().partition(b"\n")
    except OSError:
        return None
    return zlib.decompress(packed) if digest == _digest(packed) else None


def write_entry(name: str, content: bytes) -> None:
    """Keep the content; where that is not possible, nothing happens."""
    folder = cache_folder()
    packed = zlib.compress(content, 1)
    if folder is None or len(packed) >= MAX_BYTES:
        return
    file = folder / name
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        handle, part = tempfile.mkstemp(dir=file.parent, prefix=".", suffix=".part")
    except OSError:
        return
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(_digest(packed) + b"\n" + packed)
        os.replace(part, file)  # no other process reads half of it
        _prune(file.parent)
    except OSError:
        Path(part).unlink(missing_ok=True)


def _digest(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode()


def _prune(folder: Path) -> None:
    if len(os.listdir(folder)) <= MAX_ENTRIES:
        return
    with os.scandir(folder) as entries:
        by_age = sorted((entry.stat().st_mtime_ns, entry.path) for entry in entries)
    for _, path in by_age[: len(by_age) // 2]:
        Path(path).unlink(missing_ok=True)
