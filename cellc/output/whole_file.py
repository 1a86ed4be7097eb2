"""Write one file as a whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path


def write_whole(file: Path, text: str) -> None:
    """Write a text; a reader sees the old file or the new one, and a failure leaves nothing behind.

    Raises:
        OSError: the disk is full, or writing is refused; it names ``file``.
    """
    real = Path(os.path.realpath(file))
    part = real.with_name(f".{real.name}.tmp-{os.getpid()}")
    try:
        real.parent.mkdir(parents=True, exist_ok=True)
        part.write_text(text, encoding="utf-8", newline="\n")
        os.replace(part, real)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(file)) from error
    finally:
        _remove(part)


def _remove(part: Path) -> None:
    try:
        part.unlink()
    except OSError:
        # It has become the file, or never came to be.
        return
