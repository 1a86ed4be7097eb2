"""``graph/responsibility.svg``: the cell on one sheet, every arrow labeled.

SVG 1.1 without scripts, styles or fonts from elsewhere, for A4 upright: 13 units of 1000 are 7 points on the page, and
10 pixels on a phone that is held sideways. One arrow a row, from left to right who, what, to whom, so that it needs no
layout; vendor control and physical safety are boundaries of their own, drawn bold. Dashed is of what something is
UNKNOWN. Left out: the shape of the graph, which ``graph/nodes.svg`` has, and the QoS of each end, which ``audit.md``
lists.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Container, Iterable, Iterator
from itertools import accumulate, pairwise
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.arrows import Arrow, drives, exchanges, helpers, stop, unknown_boxes
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.formats.svg import Style, arrow_head, name_lines, rectangle, sheet, text
from cellc.compiler.formats.xml_text import element, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN

_WIDTH = 1000
_PAGE = 1300  # height of what an upright page holds of this width, its title and margins beside
_FONT_SIZE = 13
_LINE = 18  # height of a line of text
_MARGIN = 16  # between the edge of the sheet and what is drawn
_GAP = 14  # between rows, and between boundaries
_TITLE = 34  # height of a boundary's title
_BOX = 190  # width of the boxes at both ends of an arrow
_BOX_CHARACTERS = 24
_CHARACTERS = 84
_UNIT = re.compile(r"(?<=\d) (s|Hz)\b")
_DASHED = {"stroke-dasharray": "6 4"}
_HELD = "\N{NO-BREAK SPACE}"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the picture."""
    yield Artifact("graph/responsibility.svg", render(_sheet(graph.cell), plan.header.text))


@dataclass(frozen=True, slots=True)
class Band:
    """Arrows within one boundary; a bold one is not crossed by software of the cell."""

    title: str
    bold: bool
    rows: tuple[Arrow, ...]


def _bands(cell: Cell) -> tuple[Band, ...]:
    """Return the ROS graph, vendor control and physical safety, in the order in which a goal meets them."""
    owners = cell.owners.responsibilities
    return (
        Band("ROS 2 graph (dashed is of what something is UNKNOWN)", False, tuple(exchanges(cell))),
        Band(f"Vendor control (owner {owners.vendor_safety})", True, (*drives(cell), *helpers(cell))),
        Band(f"Physical safety (owner {owners.physical_stop})", True, tuple(stop(cell))),
    )


def _sheet(cell: Cell) -> Element:
    """Return the picture on a sheet that is as high as it needs to be."""
    bands, unknown = _bands(cell), unknown_boxes(cell)
    heights = [_TITLE + sum(map(_height, band.rows)) + _GAP for band in bands]
    tops = [_MARGIN, *(_MARGIN + total for total in accumulate(height + _GAP for height in heights))]
    drawn = (_band(band, top, height, unknown) for band, top, height in zip(bands, tops, heights, strict=False))
    head = element("defs", children=[arrow_head("head", "#000000")])
    bottom = tops[-1] + _MARGIN - _GAP
    views = _views(bands, tops, bottom)
    title = f"Every arrow of {cell.name} with its owner"
    return sheet(title, _WIDTH, bottom, _FONT_SIZE, [head, *views, *(part for parts in drawn for part in parts)])


def _views(bands: tuple[Band, ...], tops: list[int], bottom: int) -> Iterator[Element]:
    """Name the parts of the sheet that fit a page each, cut above a row or a boundary; none where all fits one."""
    cuts = [0]
    before = 0
    for band, top in zip(bands, tops, strict=False):
        rows = (top + _TITLE + offset for offset in accumulate(map(_height, band.rows[:-1])))
        for place in (top - _GAP // 2, *rows, top + _TITLE + sum(map(_height, band.rows)) + _GAP):
            if place - cuts[-1] > _PAGE and before > cuts[-1]:
                cuts.append(before)
            before = place
    for number, (start, end) in enumerate(pairwise([*cuts, bottom]), start=1):
        if len(cuts) > 1:
            yield element("view", {"id": f"page_{number}", "viewBox": f"0 {start} {_WIDTH} {end - start}"})


def _band(band: Band, top: int, height: int, unknown: Container[str]) -> Iterator[Element]:
    line = {"rx": "6", "fill": "none", "stroke": "#000000", "stroke-width": "5" if band.bold else "1"}
    yield rectangle(
        _MARGIN // 2, top, _WIDTH - _MARGIN, height, line | (_DASHED if band.bold and UNKNOWN in band.title else {})
    )
    yield text(_MARGIN + 4, top + 23, band.title, {"font-weight": "bold", "font-size": "16"})
    tops = [0, *accumulate(map(_height, band.rows))]
    for row, offset in zip(band.rows, tops, strict=False):
        yield from _row(row, top + _TITLE + offset, unknown)


def _height(row: Arrow) -> int:
    ends = max(len(_names(names)) for names in (row.starts, row.ends))
    return _LINE * max(1 + len(_wrapped(row.facts, _CHARACTERS)), ends) + _GAP


def _row(row: Arrow, top: int, unknown: Container[str]) -> Iterator[Element]:
    left, right = _MARGIN + _BOX, _WIDTH - _MARGIN - _BOX
    yield from _box(_MARGIN + 4, top + 6, row.starts, unknown)
    yield from _box(right - 4, top + 6, row.ends, unknown)
    yield text(left + 14, top + 14, row.title, {"font-weight": "bold"})
    yield _arrow(left + 8, right - 12, top + 20, _DASHED if row.is_unknown else {})
    for number, line in enumerate(_wrapped(row.facts, _CHARACTERS)):
        yield text(left + 14, top + 36 + _LINE * number, line, {"fill": "#333333"})


def _names(ends: tuple[str, ...]) -> list[str]:
    return [line for end in ends or ("none",) for line in name_lines(end, _BOX_CHARACTERS)]


def _arrow(left: int, right: int, y: int, style: Style) -> Element:
    """Return an arrow to the right."""
    line = {"x1": str(left), "y1": str(y), "x2": str(right), "y2": str(y)}
    return element("line", line | {"stroke": "#000000", "stroke-width": "1.5", "marker-end": "url(#head)", **style})


def _box(x: int, y: int, ends: tuple[str, ...], unknown: Container[str]) -> list[Element]:
    """Return a box that is as high as the names in it."""
    lines = _names(ends)
    is_unknown = any(end in unknown for end in ends)
    outline = {"rx": "5", "fill": "#eef2f7", "stroke": "#51606f"} | (_DASHED if is_unknown else {})
    names = (text(x + 8, y + 16 + _LINE * number, line) for number, line in enumerate(lines))
    return [rectangle(x, y, _BOX, _LINE * len(lines) + 8, outline), *names]


def _wrapped(parts: Iterable[str], characters: int) -> list[str]:
    """Return lines that are no longer than a number of characters; each part begins one, a unit stays at its number."""
    held = (_UNIT.sub(f"{_HELD}\\1", part) for part in parts)
    return [line.replace(_HELD, " ") for part in held for line in textwrap.wrap(part, characters)]
