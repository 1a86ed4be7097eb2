"""Edits within the lines of a user's file, which is replaced as a whole or not at all."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

_LINE = re.compile(r"[^\r\n]*(?:\r\n|\r|\n|$)")
_BYTE_ORDER_MARK = "\ufeff"


@dataclass(frozen=True, slots=True)
class Edit:
    """Characters ``column`` to ``end_column`` of a line, from 1 and the end exclusive, become ``text``.

    ``message`` says it to the user, such as "`velocty` becomes `velocity`".
    """

    file: str
    line: int
    column: int
    end_column: int
    text: str
    message: str


def apply_edits(content: str, edits: Iterable[Edit]) -> str:
    """Return a file's content with edits that do not overlap; a line break in an edit becomes that of the file.

    Args:
        content: as stored, with its own line breaks and byte order mark, which both stay.
    """
    mark = _BYTE_ORDER_MARK if content.startswith(_BYTE_ORDER_MARK) else ""
    lines = _LINE.findall(content.removeprefix(mark))
    for edit in sorted(edits, key=lambda one: (one.line, one.column), reverse=True):
        line = lines[edit.line - 1]
        lines[edit.line - 1] = line[: edit.column - 1] + edit.text + line[edit.end_column - 1 :]
    return mark + "".join(lines)


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
