"""Answers that are expensive to compute, kept in the user's cache folder by what was asked.

`CELLC_NO_CACHE=1` turns it off. The folder may be deleted at any time, and a result never depends on what is in it. An
entry is packed, signed, put in place in one step, and checked when it is read.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import sys
import zlib
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from cellc.contract.frozen import dataclass
from cellc.contract.store.cache_key import cache_key, is_private, is_shipped_with, user_folder
from cellc.contract.store.regular_file import own_bytes, read_regular
from cellc.contract.store.swap import remove_file, replace_whole
from cellc.version import __version__, installed

if TYPE_CHECKING:
    from pydantic import TypeAdapter

OFF = "CELLC_NO_CACHE"
MAX_BYTES = 10_000_000
"""A larger entry is not one that cellc wrote."""

MAX_CONTENT_BYTES = 50_000_000
"""Nor is one that unpacks to more."""

MAX_ENTRIES = 2000
"""Entries of one kind; when there are more, the older half goes."""


@dataclass(frozen=True, slots=True)
class Program:
    """What decides the answers apart from their questions: an entry that other code wrote is not read.

    Args:
        code: packages and modules of cellc.
        libraries: distributions that are asked.
    """

    code: tuple[str, ...]
    libraries: tuple[str, ...]


GEOMETRY = Program(
    (
        "compiler/feasibility",
        "robot/planning",
        "robot/description",
        "contract/transforms.py",
        "contract/control_law.py",
    ),
    ("pin", "coal", "numpy"),
)

_Answer = TypeVar("_Answer")


def cache_folder(environment: Mapping[str, str] = os.environ, platform: str = sys.platform) -> Path | None:
    """Return the folder of cellc in the user's cache folder; it need not exist.

    `XDG_CACHE_HOME` counts on every platform, as the XDG Base Directory Specification has it where it is absolute.

    Returns:
        None where the cache is turned off, or the user has no home.
    """
    if environment.get(OFF, "") not in ("", "0"):
        return None
    places = {"": ".cache/cellc", "win32": "AppData/Local/cellc/cache", "darwin": "Library/Caches/cellc"}
    return user_folder("XDG_CACHE_HOME", places, environment, platform)


_adapters: dict[type, TypeAdapter[Any]] = {}
"""What reads and writes a type: to make one takes a tenth of the check of a small cell."""


def entry_name(kind: str, question: str, program: Program) -> str:
    """Return the path of an entry in the cache folder."""
    digest = hashlib.sha256("\0".join((__version__, _content(program), kind, question)).encode()).hexdigest()
    return f"{kind}/{digest}.json"


@cache
def _content(program: Program) -> str:
    root = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256()
    for name in program.code:
        for file in [root / name] if name.endswith(".py") else sorted((root / name).glob("*.py")):
            digest.update(f"{file.name}\0".encode() + own_bytes(file) + b"\0")
    digest.update("\0".join((sys.version, *map(installed, program.libraries))).encode())
    return digest.hexdigest()


def recall(
    kind: str,
    question: str,
    answer: type[_Answer],
    compute: Callable[[], _Answer],
    is_kept: Callable[[_Answer], bool] = lambda _: True,
    asked_by: Path | None = None,
    program: Program = GEOMETRY,
) -> _Answer:
    """Return the kept answer to a question, or compute it.

    A missing, unreadable or damaged entry, and a folder that cannot be written, cost time and nothing else.

    Args:
        kind: folder of the entry.
        question: everything that the answer depends on, apart from the program; of files that are read, the content.
        answer: a type that pydantic reads and writes, such as a dataclass.
        is_kept: whether a computed answer is the answer to this question for ever: no file changed under it, and it
            does not rest on what the machine had left.
        asked_by: the spec that it is about; a cache in its working tree is not used.
        program: what computes it.
    """
    global _passing
    if cache_folder() is None:
        return compute()
    # What was built before is found without models.
    from pydantic import TypeAdapter, ValidationError

    adapter: TypeAdapter[_Answer] = _adapters.get(answer) or _adapters.setdefault(answer, TypeAdapter(answer))
    name = entry_name(kind, question, program)
    content = read_entry(name, asked_by)
    if content is not None:
        try:
            recalled = adapter.validate_json(content)
            if adapter.dump_json(recalled) == content:
                return recalled
        except ValidationError:
            pass
        # Not as this program writes it: of another release whose code looked the same.
    computed = compute()
    if is_kept(computed):
        write_entry(name, adapter.dump_json(computed), asked_by)
    else:
        _passing += 1
    return computed


_passing = 0


def passing_answers() -> int:
    """Return how many answers this process has given that are not kept: what rests on one is not kept either."""
    return _passing


def read_entry(name: str, asked_by: Path | None = None) -> bytes | None:
    """Return the content of an entry, or None, or it is not as this user wrote it."""
    place = _place(name, asked_by)
    if place is None:
        return None
    file, key = place
    try:
        data = read_regular(file, MAX_BYTES, follow=False)
    except OSError:
        return None
    signature, _, packed = data.partition(b"\n")
    if signature != _signature(key, name, packed):
        return None
    unpacking = zlib.decompressobj()
    try:
        content = unpacking.decompress(packed, MAX_CONTENT_BYTES)
    except zlib.error:
        return None
    return content if unpacking.eof else None


def write_entry(name: str, content: bytes, asked_by: Path | None = None) -> None:
    """Keep the content; where that is not possible, nothing happens."""
    packed = zlib.compress(content, 1)
    place = _place(name, asked_by)
    if place is None or len(packed) >= MAX_BYTES or len(content) > MAX_CONTENT_BYTES:
        return
    file, key = place
    # The folder may be damaged or full.
    with contextlib.suppress(OSError):
        replace_whole(file, _signature(key, name, packed) + b"\n" + packed)
        _prune(file.parent)


def _place(name: str, asked_by: Path | None) -> tuple[Path, bytes] | None:
    """Return the file of an entry and the key of its signature; None where folders or key are not this user's alone."""
    folder = cache_folder()
    if folder is None or is_shipped_with(folder, asked_by):
        return None
    file = folder / name
    try:
        key = cache_key(asked_by) if is_private(folder) and is_private(file.parent) else None
    except OSError:
        return None
    return None if key is None else (file, key)


def _signature(key: bytes, name: str, packed: bytes) -> bytes:
    # The name is in it: the bytes of one entry in the place of another are the answer to another question.
    return hashlib.blake2b(name.encode() + b"\0" + packed, key=key, digest_size=32).hexdigest().encode()


_ENTRY = re.compile(r"[0-9a-f]{64}\.json")


def _prune(folder: Path) -> None:
    # Through a link stand somebody else's files, and beside ours may stand what is not ours.
    if folder.is_symlink() or len(os.listdir(folder)) <= MAX_ENTRIES:
        return
    with os.scandir(folder) as entries:
        answers = [entry for entry in entries if _ENTRY.fullmatch(entry.name) and entry.is_file(follow_symlinks=False)]
        by_age = sorted((entry.stat(follow_symlinks=False).st_mtime_ns, entry.path) for entry in answers)
    for _, path in by_age[: len(by_age) // 2]:
        remove_file(Path(path))
