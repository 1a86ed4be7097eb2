"""Numbers the units of the chapter, as docs/coverage.md refers to them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

_NUMBERED_BY_NAME = {"Overview": "0", "Manufacturing Cell Checkpoint": "14", "What to Learn Next": "15"}
_END = "Annotated research trail"
_BOUNDARY = re.compile(r"(?<=[.!?”])(?: ?\[\d+\])*\s+(?=[“A-Z\-])")
_CITATIONS = re.compile(r"(\[\d+\] ?)+")


def units(chapter: Path) -> dict[str, str]:
    """Return every sentence, heading, item and row of a table by `section.number`, counted from 1 in each section."""
    texts: dict[str, list[str]] = {}
    section = ""
    for line in chapter.read_text(encoding="utf-8").splitlines():
        if (heading := _section(line)) is not None:
            section = heading
        elif line.strip() == _END:
            break
        elif section:
            texts.setdefault(section, []).extend(_split(line))
    return {f"{key}.{number}": text for key, found in texts.items() for number, text in enumerate(found, start=1)}


def expand(where: str) -> Iterator[str]:
    """Yield the numbers of a list such as ``3.3–3.5, 3.25``."""
    for part in where.split(", "):
        first, _, last = part.partition("–")
        section, start = first.split(".")
        end = last.split(".")[1] if last else start
        yield from (f"{section}.{number}" for number in range(int(start), int(end) + 1))


def _section(line: str) -> str | None:
    if line.strip() in _NUMBERED_BY_NAME:
        return _NUMBERED_BY_NAME[line.strip()]
    numbered = re.match(r"(\d+)\. \S", line)
    return numbered[1] if numbered else None


def _split(line: str) -> Iterator[str]:
    parts = [line.strip()] if line.startswith("  ") else _BOUNDARY.split(line.strip())
    yield from (part for part in parts if part and not _CITATIONS.fullmatch(part))
