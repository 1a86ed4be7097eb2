"""Places in the files that the user wrote."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

YamlPath = tuple[Union[str, int], ...]
"""Keys and list indices from the root of a YAML document to one of its nodes."""


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A half-open range of text; lines and columns count from 1, columns count characters.

    ``file`` is the path as the user named it, with forward slashes, so that output is the same on every machine.
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


def format_path(path: YamlPath) -> str:
    """Write a YAML path as ``devices.arm.mount`` or ``steps[2].move``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += f".{part}" if text else part
    return text
