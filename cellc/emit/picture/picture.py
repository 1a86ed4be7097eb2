"""``graph/responsibility.svg``: the cell on one page, every arrow labelled (chapter 4, last section).

SVG 1.1 without scripts, styles or fonts from elsewhere. One arrow a row, so that it needs no layout and stays readable
on paper and on a phone; vendor control and physical safety are boundaries of their own, drawn bold. Left out: the shape
of the graph, which ``graph/responsibility.mmd`` shows where a viewer lays it out.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.emit.picture.drawing import draw
from cellc.emit.picture.rows import bands
from cellc.formats.header import Header
from cellc.formats.xml_text import render
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the picture."""
    yield Artifact("graph/responsibility.svg", render(draw(bands(graph.cell)), header.text))
