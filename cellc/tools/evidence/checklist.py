"""Filled-in copies of the checklists in ``gates/``: what is ticked, and what the result line says."""

from __future__ import annotations

import re
from collections.abc import Mapping

from cellc.contract.frozen import dataclass

PAGES = ("gates/promotion.md", "gates/network.md")
_SECTION = re.compile(r"^## ([GL]\d) .*$", re.MULTILINE)
_BOX = re.compile(r"^- \[([ xX])\] (.*?)\s*$", re.MULTILINE)
_RESULT = re.compile(
    r"^Result \(passed or stopped\): (.*?) Name: (.*?) Date, time: (.*?) Signature: (.*?)\s*$", re.MULTILINE
)


@dataclass(frozen=True, slots=True)
class Section:
    """One gate of a page.

    Attributes:
        boxes: each line, and whether it is ticked.
        result, name, date: of its last line; empty where they are blank.
    """

    boxes: tuple[tuple[str, bool], ...]
    result: str = ""
    name: str = ""
    date: str = ""

    @property
    def open(self) -> tuple[str, ...]:
        """The lines that are not ticked."""
        return tuple(text for text, ticked in self.boxes if not ticked)

    @property
    def texts(self) -> tuple[str, ...]:
        """The lines without what people filled in."""
        return tuple(text for text, _ in self.boxes)


def sections_of(page: str) -> Mapping[str, Section]:
    """Return what a page says of each gate, by its code."""
    parts = _SECTION.split(page.replace("\r\n", "\n"))
    return {code: _section(text) for code, text in zip(parts[1::2], parts[2::2], strict=True)}


def _section(text: str) -> Section:
    boxes = tuple((box[2], box[1] != " ") for box in _BOX.finditer(text))
    result = _RESULT.search(text)
    if result is None:
        return Section(boxes)
    said, name, date, _ = (each.strip(" _") for each in result.groups())
    return Section(boxes, said, name, date)
