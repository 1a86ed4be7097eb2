"""``graph/responsibility.svg``: the cell on one sheet, every arrow labeled.

SVG 1.1 without scripts, styles or fonts from elsewhere, for A4 upright: 13 units of 1000 are 7 points on the page, and
10 pixels on a phone that is held sideways. One arrow a row, from left to right who, what, to whom, so that it needs no
layout; vendor control and physical safety are boundaries of their own, drawn bold. Left out: the shape of the graph,
which ``graph/responsibility.mmd`` shows where a viewer lays it out.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import accumulate
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Interface
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.labels import (
    claim_facts,
    driver_facts,
    interface_facts,
    stop_facts,
    unused,
    unused_facts,
    unused_title,
)
from cellc.compiler.formats.escape import one_line
from cellc.compiler.formats.xml_text import element, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import InterfaceKind

_WIDTH = 1000
_FONT_SIZE = 13
_LINE = 18  # height of a line of text
_MARGIN = 16  # between the edge of the sheet and what is drawn
_GAP = 14  # between rows, and between boundaries
_TITLE = 34  # height of a boundary's title
_BOX = 190  # width of the boxes at both ends of an arrow
_BOX_CHARACTERS = 24
_CHARACTERS = 84
_UNIT = re.compile(r"(?<=\d) (s|Hz)\b")
_HELD = "\N{NO-BREAK SPACE}"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the picture."""
    yield Artifact("graph/responsibility.svg", render(_sheet(_bands(graph.cell)), plan.header.text))


@dataclass(frozen=True, slots=True)
class Row:
    """One arrow with what it carries; several names at an end share it."""

    starts: tuple[str, ...]
    title: str
    facts: tuple[str, ...]
    ends: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Band:
    """Rows within one boundary; a bold one is not crossed by software of the cell."""

    title: str
    bold: bool
    rows: tuple[Row, ...]


def _bands(cell: Cell) -> tuple[Band, ...]:
    """Return the ROS graph, vendor control and physical safety, in the order in which a goal meets them."""
    owners = cell.owners.responsibilities
    return (
        Band("ROS 2 graph", False, tuple(_exchanges(cell))),
        Band(f"Vendor control (owner {owners.vendor_safety})", True, (*_claims(cell), *_drivers(cell))),
        Band(f"Physical safety (owner {owners.physical_stop})", True, tuple(_stops(cell))),
    )


def _exchanges(cell: Cell) -> Iterator[Row]:
    groups = unused(cell)
    alone = {interface.name for group in groups for interface in group}
    yield from (_exchange(interface) for interface in cell.interfaces if interface.name not in alone)
    for group in groups:
        sources, facts = tuple(end.node for end in group[0].sources), tuple(unused_facts(group))
        starts, ends = (sources, ("none",)) if group[0].kind is InterfaceKind.TOPIC else (("none",), sources)
        yield Row(starts, unused_title(group), facts, ends)


def _exchange(interface: Interface) -> Row:
    sources = tuple(end.node for end in interface.sources)
    sinks = tuple(end.node for end in interface.sinks)
    # A sample travels to the subscriber, a goal or a request to the server.
    starts, ends = (sources, sinks) if interface.kind is InterfaceKind.TOPIC else (sinks, sources)
    return Row(starts or ("none",), interface.name, tuple(interface_facts(interface)), ends or ("none",))


def _claims(cell: Cell) -> Iterator[Row]:
    for manager in cell.managers:
        for controller in manager.controllers:
            if controller.device is not None and controller.command_interfaces:
                facts = tuple(claim_facts(cell, manager, controller))
                yield Row((controller.label,), "claims", facts, (controller.device,))


def _drivers(cell: Cell) -> Iterator[Row]:
    """Yield what moves a device past every controller manager."""
    for device in cell.devices:
        if device.driver is not None:
            yield Row((device.driver.node,), "moves", tuple(driver_facts(cell, device, device.driver)), (device.name,))


def _stops(cell: Cell) -> Iterator[Row]:
    devices = tuple(device.name for device in cell.devices if device.is_driven)
    if devices:
        yield Row((cell.safety.stop.authority,), "stops, independent of software", tuple(stop_facts(cell)), devices)


def _sheet(bands: tuple[Band, ...]) -> Element:
    """Return the picture on a sheet that is as high as it needs to be."""
    heights = [_TITLE + sum(map(_height, band.rows)) + _GAP for band in bands]
    tops = [_MARGIN, *(_MARGIN + total for total in accumulate(height + _GAP for height in heights))]
    attributes = {
        "xmlns": "http://www.w3.org/2000/svg",
        "viewBox": f"0 0 {_WIDTH} {tops[-1] + _MARGIN - _GAP}",
        "font-family": "sans-serif",
        "font-size": str(_FONT_SIZE),
    }
    drawn = (_band(band, top, height) for band, top, height in zip(bands, tops, heights, strict=False))
    background = element("rect", {"width": "100%", "height": "100%", "fill": "#ffffff"})
    return element("svg", attributes, [_arrow_head(), background, *(part for parts in drawn for part in parts)])


def _band(band: Band, top: int, height: int) -> Iterator[Element]:
    place = {"x": str(_MARGIN // 2), "y": str(top), "width": str(_WIDTH - _MARGIN), "height": str(height)}
    line = {"rx": "6", "fill": "none", "stroke": "#000000", "stroke-width": "5" if band.bold else "1"}
    yield element("rect", place | line)
    yield _text(_MARGIN + 4, top + 23, band.title, {"font-weight": "bold", "font-size": "16"})
    tops = [0, *accumulate(map(_height, band.rows))]
    for row, offset in zip(band.rows, tops, strict=False):
        yield from _row(row, top + _TITLE + offset)


def _height(row: Row) -> int:
    ends = max(len(_wrapped(names, _BOX_CHARACTERS)) for names in (row.starts, row.ends))
    return _LINE * max(1 + len(_wrapped(row.facts, _CHARACTERS)), ends) + _GAP


def _row(row: Row, top: int) -> Iterator[Element]:
    left, right = _MARGIN + _BOX, _WIDTH - _MARGIN - _BOX
    yield from _box(_MARGIN + 4, top + 6, _BOX, _wrapped(row.starts, _BOX_CHARACTERS))
    yield from _box(right - 4, top + 6, _BOX, _wrapped(row.ends, _BOX_CHARACTERS))
    yield _text(left + 14, top + 14, row.title, {"font-weight": "bold"})
    yield _arrow(left + 8, right - 12, top + 20)
    for number, line in enumerate(_wrapped(row.facts, _CHARACTERS)):
        yield _text(left + 14, top + 36 + _LINE * number, line, {"fill": "#333333"})


def _text(x: int, y: int, said: str, style: dict[str, str]) -> Element:
    """Return a line of text; ``y`` is its base line."""
    return element("text", {"x": str(x), "y": str(y)} | style, text=one_line(said))


def _arrow(left: int, right: int, y: int) -> Element:
    """Return an arrow to the right."""
    line = {"x1": str(left), "y1": str(y), "x2": str(right), "y2": str(y)}
    return element("line", line | {"stroke": "#000000", "stroke-width": "1.5", "marker-end": "url(#head)"})


def _box(x: int, y: int, width: int, lines: list[str]) -> list[Element]:
    """Return a box that is as high as the names in it."""
    size = {"width": str(width), "height": str(_LINE * len(lines) + 8), "rx": "5"}
    outline = element("rect", {"x": str(x), "y": str(y)} | size | {"fill": "#eef2f7", "stroke": "#51606f"})
    return [outline, *(_text(x + 8, y + 16 + _LINE * number, line, {}) for number, line in enumerate(lines))]


def _wrapped(parts: Iterable[str], characters: int) -> list[str]:
    """Return lines that are no longer than a number of characters; each part begins one, a unit stays at its number."""
    held = (_UNIT.sub(f"{_HELD}\\1", part) for part in parts)
    return [line.replace(_HELD, " ") for part in held for line in textwrap.wrap(part, characters)]


def _arrow_head() -> Element:
    """Return the definition that arrows refer to."""
    attributes = {"id": "head", "viewBox": "0 0 8 8", "refX": "7", "refY": "4", "markerWidth": "7", "markerHeight": "7"}
    marker = element("marker", attributes | {"orient": "auto"}, [element("path", {"d": "M0 0 L8 4 L0 8 Z"})])
    return element("defs", children=[marker])
