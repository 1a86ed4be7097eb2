"""Replace a user's file as a whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path

from cellc.edit.edit import Edit, apply_edits


def rewrite(file: Path, edits: Sequence[Edit], expected: str) -> bool:
    """Apply edits to a file; return False where it is no longer what was checked.

    A reader sees the old or the new file, never a part; permissions stay, and a link keeps leading to its file.

    Args:
        expected: the text that was checked, with line breaks as ``\\n`` and without byte order mark.

    Raises:
        OSError: the folder cannot be written; the file is as it was.
    """
    real = file.resolve()
    content = real.read_bytes().decode("utf-8")
    if _normalised(content) != expected:
        return False
    broken = "\r\n" if "\r\n" in content else "\n"
    own = [Edit(e.file, e.line, e.column, e.end_column, e.text.replace("\n", broken), e.message) for e in edits]
    descriptor, name = tempfile.mkstemp(prefix=f".{real.name}.", suffix=".cellc", dir=real.parent)
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(apply_edits(content, own).encode("utf-8"))
            stream.flush()
            os.fsync(stream.fileno())
        shutil.copymode(real, name)
        os.replace(name, real)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    return True


def _normalised(content: str) -> str:
    return content.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
