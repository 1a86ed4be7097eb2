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
and some hundred megabytes, and ends with a message that names the file, the limit and the option. A real cell stays far
below.

`--limit NAME=VALUE` raises a limit for one call of `cellc check`, `build`, `audit`, `show`, `diagnose`, `diff` or
`mock`; it may be given several times. A value is a whole number, from the default to the largest; an unknown name ends
with 2 and lists the names.

| limit | default | largest | it bounds |
|---|---|---|---|
"""


def page() -> str:
    """Return the page as it must be."""
    return _HEAD + "".join(_lines())


def _lines() -> Iterator[str]:
    for name, row in rows().items():
        yield f"| `{name}` | {_shown(default(name), row.unit)} | {_shown(row.highest, row.unit)} | {row.bounds} |\n"


def _shown(value: int, unit: str) -> str:
    for size, word in ((MIB, "MiB"), (KIB, "KiB")) if unit == "bytes" else ():
        if value % size == 0:
            return f"{value // size:,} {word}"
    return f"{value:,} {unit}"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
