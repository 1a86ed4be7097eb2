"""Filled-in copies of the checklists in ``gates/``: what is ticked, and what the result line says."""

from __future__ import annotations

import re
from collections.abc import Mapping

from cellc.contract.frozen import dataclass

PAGES = ("gates/promotion.md", "gates/network.md")
_SECTION = re.compile(r"^## ([GL]\d) .*$", re.MULTILINE)
_BOX = re.compile(r"^- \[([ xX-])\] ([^\n]*)$", re.MULTILINE)
_BLANKS = ("Result (passed or stopped): ", " Name: ", " Date, time: ", " Signature: ")


@dataclass(frozen=True, slots=True)
class Section:
    """One gate of a page.

    Attributes:
        boxes: each line, and what is in its box: a blank, `x`, or `-` where it does not apply.
        result, name, date: of its last line; empty where they are blank.
    """

    boxes: tuple[tuple[str, str], ...]
    result: str = ""
    name: str = ""
    date: str = ""

    @property
    def open(self) -> tuple[str, ...]:
        """The lines that are not marked."""
        return tuple(text for text, mark in self.boxes if mark == " ")

    @property
    def is_started(self) -> bool:
        """Whether anything is filled in."""
        return len(self.open) < len(self.boxes) or bool(self.result)

    def without_reason(self, printed: Section) -> tuple[str, ...]:
        """Return the lines that do not apply, but do not say why behind their printed text."""
        pairs = zip(self.boxes, printed.boxes, strict=True)
        return tuple(own for (own, mark), (text, _) in pairs if mark == "-" and own == text)

    def is_copy_of(self, printed: Section) -> bool:
        """Whether its lines are those that were printed, behind which people may have written something."""
        pairs = zip(self.boxes, printed.boxes, strict=False)
        return len(self.boxes) == len(printed.boxes) and all(own.startswith(text) for (own, _), (text, _) in pairs)


def sections_of(page: str) -> Mapping[str, Section]:
    """Return what a page says of each gate, by its code."""
    parts = _SECTION.split(page.replace("\r\n", "\n"))
    return {code: _section(text) for code, text in zip(parts[1::2], parts[2::2], strict=True)}


def _section(text: str) -> Section:
    boxes = tuple((box[2].strip(), box[1].lower()) for box in _BOX.finditer(text))
    lines = (line for line in text.splitlines() if line.startswith(_BLANKS[0]))
    filled, rest = list[str](), next(lines, "").removeprefix(_BLANKS[0])
    for blank in _BLANKS[1:]:
        before, _, rest = rest.partition(blank)
        filled.append(before.strip(" _"))
    return Section(boxes, *filled)
