"""``graph/responsibility.svg``, ``….phone.svg``: the cell on one sheet, every arrow labelled (chapter 4, last section).

SVG 1.1 without scripts, styles or fonts from elsewhere: one for A4 upright, one for a phone, whose width takes letters
that are read without a glass. One arrow a row, so that it needs no layout; vendor control and physical safety are
boundaries of their own, drawn bold. Left out: the shape of the graph, which ``graph/responsibility.mmd`` shows where a
viewer lays it out.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.emit.picture.drawing import draw
from cellc.emit.picture.page import PAGE
from cellc.emit.picture.phone import PHONE
from cellc.emit.picture.rows import bands
from cellc.formats.header import Header
from cellc.formats.xml_text import render
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the picture on both sheets."""
    drawn = bands(graph.cell)
    yield Artifact("graph/responsibility.svg", render(draw(drawn, PAGE), header.text))
    yield Artifact("graph/responsibility.phone.svg", render(draw(drawn, PHONE), header.text))
