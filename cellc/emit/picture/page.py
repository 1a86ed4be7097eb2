"""A4 upright: from left to right who, what, to whom; 13 units of 1000 are 7 points on the page."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.emit.picture.layout import GAP, MARGIN, Layout
from cellc.emit.picture.rows import Row
from cellc.emit.picture.shapes import LINE, arrow, box, text, wrapped

_WIDTH = 1000
_BOX = 190
_BOX_CHARACTERS = 24
_CHARACTERS = 84


def _height(row: Row) -> int:
    ends = max(len(wrapped(names, _BOX_CHARACTERS)) for names in (row.starts, row.ends))
    return LINE * max(1 + len(wrapped(row.facts, _CHARACTERS)), ends) + GAP


def _draw(row: Row, top: int) -> Iterator[Element]:
    left, right = MARGIN + _BOX, _WIDTH - MARGIN - _BOX
    yield from box(MARGIN + 4, top + 6, _BOX, wrapped(row.starts, _BOX_CHARACTERS))
    yield from box(right - 4, top + 6, _BOX, wrapped(row.ends, _BOX_CHARACTERS))
    yield text(left + 14, top + 14, row.title, {"font-weight": "bold"})
    yield arrow(left + 8, right - 12, top + 20)
    for number, line in enumerate(wrapped(row.facts, _CHARACTERS)):
        yield text(left + 14, top + 36 + LINE * number, line, {"fill": "#333333"})


PAGE = Layout(_WIDTH, 13, _height, _draw)
"""The sheet that is printed."""
