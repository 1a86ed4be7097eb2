"""Ways in which an entry of the cache can be spoilt."""

from __future__ import annotations

import os
import random
import shutil
import zlib
from collections.abc import Callable
from pathlib import Path

NOBODY = 65534
"""The user of nobody, on most systems."""


def _flip(entry: Path, chance: random.Random) -> None:
    content = bytearray(entry.read_bytes())
    content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
    entry.write_bytes(content)


def _instead(entry: Path, make: Callable[[Path], object]) -> None:
    entry.unlink()
    make(entry)


def _in_place_of_folder(entry: Path, make: Callable[[Path], object]) -> None:
    shutil.rmtree(entry.parent)
    make(entry.parent)


DAMAGES: dict[str, Callable[[Path, random.Random], object]] = {
    "a bit flipped": _flip,
    "cut short": lambda entry, chance: os.truncate(entry, chance.randrange(entry.stat().st_size)),
    "longer": lambda entry, _: entry.write_bytes(entry.read_bytes() * 2),
    "zeros": lambda entry, _: entry.write_bytes(bytes(entry.stat().st_size)),
    "of another user": lambda entry, _: os.chown(entry, NOBODY, NOBODY),
    "packed by somebody": lambda entry, _: entry.write_bytes(zlib.compress(b"{}")),
    "a folder": lambda entry, _: _instead(entry, Path.mkdir),
    "a pipe": lambda entry, _: _instead(entry, os.mkfifo),
    "a link to nowhere": lambda entry, _: _instead(entry, lambda path: path.symlink_to("nowhere")),
    "a link to itself": lambda entry, _: _instead(entry, lambda path: path.symlink_to(path.name)),
    "a link to endless zeros": lambda entry, _: _instead(entry, lambda path: path.symlink_to("/dev/zero")),
    "unreadable": lambda entry, _: entry.chmod(0),
    "its folder a file": lambda entry, _: _in_place_of_folder(entry, Path.touch),
    "its folder a link to nowhere": lambda entry, _: _in_place_of_folder(
        entry, lambda path: path.symlink_to("nowhere")
    ),
    "half of one beside it": lambda entry, _: entry.with_name(f".{entry.name}.tmp-4194305").write_bytes(b"half"),
}
