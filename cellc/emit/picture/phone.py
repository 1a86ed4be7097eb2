"""A phone held upright: who and to whom above, what below; 15 units of 480 are 11 of its 360 pixels."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.emit.picture.layout import GAP, MARGIN, Layout
from cellc.emit.picture.rows import Row
from cellc.emit.picture.shapes import LINE, arrow, box, text, wrapped

_WIDTH = 480
_BOX = 204
_BOX_CHARACTERS = 22
_CHARACTERS = 48


def _ends_height(row: Row) -> int:
    return LINE * max(len(wrapped(names, _BOX_CHARACTERS)) for names in (row.starts, row.ends)) + 12


def _height(row: Row) -> int:
    return _ends_height(row) + LINE * (1 + len(wrapped(row.facts, _CHARACTERS))) + 6 + GAP


def _draw(row: Row, top: int) -> Iterator[Element]:
    left, right = MARGIN + 4, _WIDTH - MARGIN - 4 - _BOX
    yield from box(left, top, _BOX, wrapped(row.starts, _BOX_CHARACTERS))
    yield arrow(left + _BOX + 4, right - 4, top + 13)
    yield from box(right, top, _BOX, wrapped(row.ends, _BOX_CHARACTERS))
    below = top + _ends_height(row) + 14
    yield text(left, below, row.title, {"font-weight": "bold"})
    for number, line in enumerate(wrapped(row.facts, _CHARACTERS)):
        yield text(left, below + LINE * (1 + number), line, {"fill": "#333333"})


PHONE = Layout(_WIDTH, 15, _height, _draw)
"""The sheet that is read at the cell."""
