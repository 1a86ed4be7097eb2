"""What can happen to the folder that answers are kept in."""

from __future__ import annotations

import hashlib
import json
import os
import random
import shutil
import zlib
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path

from cellc.contract.store.cache_key import state_folder

Damage = Callable[[Path, Sequence[Path], random.Random], None]


def damage_cache(folder: Path, damages: Sequence[str], chance: random.Random) -> None:
    """Damage the folder in the ways that are named, one after the other."""
    for name in damages:
        # What was a link before is not followed: nothing outside of the folder is ever touched.
        found = folder.rglob("*.json") if folder.is_dir() and not folder.is_symlink() else ()
        entries = sorted(file for file in found if file.is_file() and not file.is_symlink())
        if entries:
            _DAMAGES[name](folder, entries, chance)


def _signed(entry: Path, packed: bytes) -> bytes:
    """Return an entry whose signature fits its name, as only this user can write it."""
    name, folder = f"{entry.parent.name}/{entry.name}".encode(), state_folder()
    assert folder is not None
    key = (folder / "cache.key").read_bytes()
    return hashlib.blake2b(name + b"\0" + packed, key=key, digest_size=32).hexdigest().encode() + b"\n" + packed


def _content(entry: Path) -> object:
    """Return what an entry holds; nothing where it is damaged already."""
    try:
        packed = entry.read_bytes().partition(b"\n")[2]
        return json.loads(zlib.decompressobj().decompress(packed, 1_000_000).strip())
    except (zlib.error, ValueError):
        return None


def _replaced(entry: Path, data: bytes) -> None:
    entry.unlink()
    entry.write_bytes(data)


def _cut(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    for entry in entries:
        data = entry.read_bytes()
        _replaced(entry, data[: chance.randrange(len(data) or 1)])


def _noise(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    for entry in entries:
        data = bytearray(entry.read_bytes())
        if data:
            data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        _replaced(entry, bytes(data))


def _shuffled(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    """Give every entry the bytes of another one of its kind, as a careless copy of the folder does."""
    for kind in {entry.parent for entry in entries}:
        of_kind = [entry for entry in entries if entry.parent == kind]
        datas = [entry.read_bytes() for entry in of_kind]
        for entry, data in zip(of_kind, datas[1:] + datas[:1], strict=True):
            _replaced(entry, data)


def _copied(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    """Give every entry the bytes of one, of whatever kind."""
    data = chance.choice(entries).read_bytes()
    for entry in entries:
        _replaced(entry, data)


def _other_shape(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    shapes: tuple[object, ...] = (
        {},
        [],
        None,
        1,
        "x",
        {"pairs": 1},
        {"start": [[1, 2]], "poses": None},
        {"goals": [{"name": {}}]},
    )
    for entry in entries:
        content = _content(entry)
        if isinstance(content, dict) and chance.random() < 0.5 and content:
            content[chance.choice(sorted(content))] = {"x": []}
        else:
            content = chance.choice(shapes)
        _replaced(entry, _signed(entry, zlib.compress(json.dumps(content).encode())))


def _every(data: Callable[[Path], bytes]) -> Damage:
    def change(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
        for entry in entries:
            _replaced(entry, data(entry))

    return change


def _garbled(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    """A sum that fits, over what is not packed."""
    for entry in entries:
        data = bytes(chance.randrange(256) for _ in range(40))
        _replaced(entry, _signed(entry, data))


@cache
def _bomb() -> bytes:
    return zlib.compress(b" " * 60_000_000)


def _huge(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    with chance.choice(entries).open("r+b") as file:
        file.truncate(11_000_000)


def _folders(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    for entry in entries:
        entry.unlink()
        entry.mkdir()


def _links(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    target = chance.choice(("/dev/zero", "/dev/null", "loop", "nowhere"))
    for entry in entries:
        entry.unlink()
        entry.symlink_to(entry.name if target == "loop" else target)


def _fifos(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    for entry in entries:
        entry.unlink()
        os.mkfifo(entry)


def _other_version(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    for entry in entries:
        entry.rename(entry.with_name(hashlib.sha256(entry.name.encode()).hexdigest() + ".json"))


def _old_parts(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    for entry in entries:
        (entry.parent / ".abc.part").write_bytes(entry.read_bytes()[:9])


def _no_folder(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    shutil.rmtree(chance.choice((folder, entries[0].parent)))


def _file_for_folder(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    place = chance.choice((folder, entries[0].parent))
    shutil.rmtree(place)
    place.write_bytes(b"x")


def _link_for_folder(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    place = entries[0].parent
    shutil.rmtree(place)
    place.symlink_to(chance.choice(("/dev/null", "nowhere", place.name)))


def _unreadable(folder: Path, entries: Sequence[Path], chance: random.Random) -> None:
    for entry in entries:
        entry.chmod(0)


_DAMAGES: Mapping[str, Damage] = {
    "cut": _cut,
    "empty": _every(lambda entry: b""),
    "noise": _noise,
    "swap": _shuffled,
    "copy": _copied,
    "folder": _folders,
    "link": _links,
    "fifo": _fifos,
    "huge": _huge,
    "bomb": _every(lambda entry: _signed(entry, _bomb())),
    "garbled": _garbled,
    "wrong shape": _other_shape,
    "not json": _every(lambda entry: _signed(entry, zlib.compress(b"\xff{"))),
    "other version": _other_version,
    "old part": _old_parts,
    "no folder": _no_folder,
    "file for folder": _file_for_folder,
    "link for folder": _link_for_folder,
    "unreadable": _unreadable,
}
