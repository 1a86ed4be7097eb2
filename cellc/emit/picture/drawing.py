"""Bands with their rows as SVG: one boundary below the other, one arrow below the other."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import accumulate
from xml.etree.ElementTree import Element

from cellc.emit.picture.layout import GAP, MARGIN, Layout
from cellc.emit.picture.rows import Band
from cellc.emit.picture.shapes import arrow_head, text
from cellc.formats.xml_text import element

_TITLE = 34


def draw(bands: tuple[Band, ...], layout: Layout) -> Element:
    """Return the picture on a sheet that is as high as it needs to be."""
    heights = [_TITLE + sum(map(layout.height, band.rows)) + GAP for band in bands]
    tops = [MARGIN, *(MARGIN + total for total in accumulate(height + GAP for height in heights))]
    attributes = {
        "xmlns": "http://www.w3.org/2000/svg",
        "viewBox": f"0 0 {layout.width} {tops[-1] + MARGIN - GAP}",
        "font-family": "sans-serif",
        "font-size": str(layout.font_size),
    }
    drawn = (_band(band, layout, top, height) for band, top, height in zip(bands, tops, heights, strict=False))
    background = element("rect", {"width": "100%", "height": "100%", "fill": "#ffffff"})
    return element("svg", attributes, [arrow_head(), background, *(part for parts in drawn for part in parts)])


def _band(band: Band, layout: Layout, top: int, height: int) -> Iterator[Element]:
    place = {"x": str(MARGIN // 2), "y": str(top), "width": str(layout.width - MARGIN), "height": str(height)}
    line = {"rx": "6", "fill": "none", "stroke": "#000000", "stroke-width": "5" if band.bold else "1"}
    yield element("rect", place | line)
    yield text(MARGIN + 4, top + 23, band.title, {"font-weight": "bold", "font-size": "16"})
    tops = [0, *accumulate(map(layout.height, band.rows))]
    for row, offset in zip(band.rows, tops, strict=False):
        yield from layout.draw(row, top + _TITLE + offset)
