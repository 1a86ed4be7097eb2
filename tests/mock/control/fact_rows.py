"""Ties tests to the rows of the table of facts, by section and number of the row, column headings not counted."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

FACTS = Path(__file__).resolve().parents[4] / "shared" / "facts" / "follow_joint_trajectory.md"
HELD: set[tuple[str, int]] = set()
"""Section and number of every row that a test names."""

_Test = TypeVar("_Test", bound=Callable[..., None])
_HEADINGS = {"#", "accepted case", "topic", "event", "controller", "value", "error_code"}


def row(section: str, number: int) -> Callable[[_Test], _Test]:
    """Declare that a test holds a row."""

    def note(test: _Test) -> _Test:
        HELD.add((section, number))
        return test

    return note


def rows_of(section: str) -> list[str]:
    """Return the first cell of every row of a section, and of an error code or tolerance in the first."""
    text = FACTS.read_text(encoding="utf-8").partition(f"\n## {section}.")[2].partition("\n## ")[0]
    if section == "1":  # its other tables list fields of messages, which the types of the mock spell out
        codes = text.partition("| error_code | value")[2].partition("\n\n")[0]
        text = codes + text.partition("### JointTolerance")[2]
    cells = [re.split(r"(?<!\\)\|", line)[1].strip() for line in text.splitlines() if line.startswith("| ")]
    return [cell for cell in cells if cell not in _HEADINGS]
