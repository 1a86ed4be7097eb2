"""Take an answer from the cache, or compute and keep it."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from pydantic import TypeAdapter, ValidationError

from cellc.cache.folder import cache_folder
from cellc.cache.key import entry_name

MAX_BYTES = 10_000_000
"""A larger entry is not one that cellc wrote."""

_Answer = TypeVar("_Answer")


def recall(kind: str, question: str, answer: type[_Answer], compute: Callable[[], _Answer]) -> _Answer:
    """Return the kept answer to a question, or compute it.

    A missing, unreadable or damaged entry, and a folder that cannot be written, cost time and nothing else.

    Args:
        kind: folder of the entry.
        question: everything that the answer depends on, apart from the program.
        answer: a type that pydantic reads and writes, such as a dataclass.
    """
    folder = cache_folder()
    if folder is None:
        return compute()
    adapter = TypeAdapter(answer)
    file = folder / entry_name(kind, question)
    kept = _read(file, adapter)
    if kept is None:
        kept = compute()
        _write(file, adapter.dump_json(kept))
    return kept


def _read(file: Path, adapter: TypeAdapter[_Answer]) -> _Answer | None:
    try:
        if file.stat().st_size > MAX_BYTES:
            return None
        return adapter.validate_json(file.read_bytes())
    except (OSError, ValidationError):
        return None


def _write(file: Path, content: bytes) -> None:
    """Put the entry in place in one step, so that no other process reads half of it."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=file.parent, prefix=".", suffix=".part")
    except OSError:
        return
    try:
        with os.fdopen(handle, "wb") as part:
            part.write(content)
        os.replace(name, file)
    except OSError:
        Path(name).unlink(missing_ok=True)
