"""Edits within the lines of a user's file, which is replaced as a whole or not at all."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from cellc.contract.limits import limits
from cellc.contract.store.regular_file import read_regular
from cellc.contract.store.swap import replace_content

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

    Args:
        expected: the text that was checked, with line breaks as ``\\n`` and without byte order mark.

    Raises:
        OSError: the folder cannot be written; the file is as it was.
    """
    content = _content(file, expected)
    if content is None:
        return False
    broken = _line_break(content)
    replaced = [Edit(e.file, e.line, e.column, e.end_column, e.text.replace("\n", broken), e.message) for e in edits]
    replace_content(file, apply_edits(content, replaced).encode())
    return True


def replace_text(file: Path, text: str, expected: str) -> bool:
    """Put a text in the place of a file's; return False where the file is no longer what was read.

    Its line breaks become those of the file, whose byte order mark stays.

    Args:
        text: with line breaks as ``\\n`` and without byte order mark, as ``expected``.

    Raises:
        OSError: the folder cannot be written; the file is as it was.
    """
    content = _content(file, expected)
    if content is None:
        return False
    mark = _BYTE_ORDER_MARK if content.startswith(_BYTE_ORDER_MARK) else ""
    replace_content(file, (mark + text.replace("\n", _line_break(content))).encode())
    return True


def _content(file: Path, expected: str) -> str | None:
    """Return a file's content as stored; None where it is not what is expected."""
    content = read_regular(file, limits().spec_bytes).decode("utf-8", errors="replace")
    return content if normalized(content) == expected else None


def _line_break(content: str) -> str:
    return "\r\n" if "\r\n" in content else "\n"


def normalized(content: str) -> str:
    """Return a text as a reader of files gives it: with line breaks as ``\\n``, and no byte order mark."""
    return content.removeprefix(_BYTE_ORDER_MARK).replace("\r\n", "\n").replace("\r", "\n")
