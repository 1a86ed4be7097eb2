"""Rows and bands as SVG elements; lengths in user units, which are pixels at full size.

The width fits A4 upright at 10 points and a phone held across; a row is as high as its text.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from itertools import accumulate
from xml.etree.ElementTree import Element

from cellc.emit.picture.rows import Band, Row
from cellc.formats.xml_text import element

WIDTH = 900
_MARGIN = 16
_LINE = 18
_PILL = 190
_PILL_CHARACTERS = 24
_TEXT_CHARACTERS = 66
_TITLE = 34
_GAP = 14


def draw(bands: tuple[Band, ...]) -> Element:
    """Return the picture: one band below the other, one arrow below the other."""
    heights = [_band_height(band) for band in bands]
    tops = [_MARGIN, *(_MARGIN + total for total in accumulate(height + _GAP for height in heights))]
    attributes = {
        "xmlns": "http://www.w3.org/2000/svg",
        "viewBox": f"0 0 {WIDTH} {tops[-1] + _MARGIN - _GAP}",
        "font-family": "sans-serif",
        "font-size": "13",
    }
    drawn = (_band(band, top, height) for band, top, height in zip(bands, tops, heights, strict=False))
    background = element("rect", {"width": "100%", "height": "100%", "fill": "#ffffff"})
    return element("svg", attributes, [_arrow_head(), background, *(part for parts in drawn for part in parts)])


def _band_height(band: Band) -> int:
    return _TITLE + sum(map(_row_height, band.rows)) + _GAP


def _row_height(row: Row) -> int:
    ends = max(sum(len(_pill_lines(name)) for name in names) for names in (row.starts, row.ends))
    return _LINE * max(1 + len(_fact_lines(row)), ends) + _GAP


def _band(band: Band, top: int, height: int) -> Iterator[Element]:
    yield element(
        "rect",
        {
            "x": str(_MARGIN // 2),
            "y": str(top),
            "width": str(WIDTH - _MARGIN),
            "height": str(height),
            "rx": "6",
            "fill": "none",
            "stroke": "#000000",
            "stroke-width": "5" if band.bold else "1",
        },
    )
    yield _text(_MARGIN + 4, top + 23, band.title, {"font-weight": "bold", "font-size": "16"})
    tops = [0, *accumulate(map(_row_height, band.rows))]
    for row, offset in zip(band.rows, tops, strict=False):
        yield from _row(row, top + _TITLE + offset)


def _row(row: Row, top: int) -> Iterator[Element]:
    left, right = _MARGIN + _PILL, WIDTH - _MARGIN - _PILL
    yield from _pill(row.starts, _MARGIN + 4, top)
    yield from _pill(row.ends, right - 4, top)
    yield _text(left + 14, top + 14, row.title, {"font-weight": "bold"})
    line = {"x1": str(left + 8), "y1": str(top + 20), "x2": str(right - 12), "y2": str(top + 20)}
    yield element("line", line | {"stroke": "#000000", "stroke-width": "1.5", "marker-end": "url(#head)"})
    for number, text in enumerate(_fact_lines(row)):
        yield _text(left + 14, top + 36 + _LINE * number, text, {"fill": "#333333"})


def _pill(names: tuple[str, ...], x: int, top: int) -> Iterator[Element]:
    lines = [line for name in names for line in _pill_lines(name)]
    size = {"width": str(_PILL), "height": str(_LINE * len(lines) + 8), "rx": "5"}
    yield element("rect", {"x": str(x), "y": str(top + 6)} | size | {"fill": "#eef2f7", "stroke": "#51606f"})
    for number, line in enumerate(lines):
        yield _text(x + 8, top + 22 + _LINE * number, line, {})


def _pill_lines(name: str) -> list[str]:
    return textwrap.wrap(name, _PILL_CHARACTERS)


def _fact_lines(row: Row) -> list[str]:
    return [line for fact in row.facts for line in textwrap.wrap(fact, _TEXT_CHARACTERS)]


def _text(x: int, y: int, text: str, style: dict[str, str]) -> Element:
    return element("text", {"x": str(x), "y": str(y)} | style, text=text)


def _arrow_head() -> Element:
    attributes = {"id": "head", "viewBox": "0 0 8 8", "refX": "7", "refY": "4", "markerWidth": "7", "markerHeight": "7"}
    marker = element("marker", attributes | {"orient": "auto"}, [element("path", {"d": "M0 0 L8 4 L0 8 Z"})])
    return element("defs", children=[marker])
