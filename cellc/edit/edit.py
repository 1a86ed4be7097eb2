"""One change within a line of a text file."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

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
