"""How one row is laid out on a sheet."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from cellc.emit.picture.rows import Row

MARGIN = 16
"""Between the edge of the sheet and what is drawn."""

GAP = 14
"""Between rows, and between boundaries."""


@dataclass(frozen=True, slots=True)
class Layout:
    """A sheet: its width and letters, and how a row is drawn from a place downwards.

    Args:
        width: user units, which are pixels at full size.
        font_size: of everything but titles.
        height: how much a row needs, with the gap below it.
        draw: the elements of a row whose upper edge is given.
    """

    width: int
    font_size: int
    height: Callable[[Row], int]
    draw: Callable[[Row, int], Iterator[Element]]
