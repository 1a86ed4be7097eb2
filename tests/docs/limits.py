"""Writes docs/limits.md: the table of `cellc/contract/limits.py` for people.

`python -m tests.docs.limits` writes it again after a row came, went or changed.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.limits import KIB, MIB, default, rows
from tests.cells import ROOT

PAGE = ROOT / "docs" / "limits.md"
_HEAD = """# Limits

cellc reads untrusted files. What it reads, expands and simulates is bounded, so that a hostile file costs seconds
and some hundred megabytes, and ends with a message that names the file and the limit. A real cell stays far below.

A large cell may need more time, memory, meshes, files or runs. `--limit NAME=VALUE` raises such a limit for one call of
`cellc check`, `build`, `audit`, `show`, `diagnose`, `diff` or `mock`; it may be given several times, and the message
names it. A value is a whole number, from the default to the largest; another name ends with 2 and lists the names.

| limit | default | largest | it bounds |
|---|---|---|---|
"""

_FIXED = """
These bounds are fixed:

| what | at most |
|---|---|
"""


def page() -> str:
    """Return the page as it must be."""
    return _HEAD + "".join(_adjustable()) + _FIXED + "".join(_fixed())


def _adjustable() -> Iterator[str]:
    for name, row in rows().items():
        if row.highest is not None:
            figures = f"{_shown(default(name), row.unit)} | {_shown(row.highest, row.unit)}"
            yield f"| `{name}` | {figures} | {row.bounds} |\n"


def _fixed() -> Iterator[str]:
    for name, row in rows().items():
        if row.highest is None:
            yield f"| {row.bounds} | {_shown(default(name), row.unit)} |\n"


def _shown(value: int, unit: str) -> str:
    for size, word in ((MIB, "MiB"), (KIB, "KiB")) if unit == "bytes" else ():
        if value % size == 0:
            return f"{value // size:,} {word}"
    return f"{value:,} {unit}"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
