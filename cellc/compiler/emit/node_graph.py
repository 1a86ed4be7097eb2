"""``graph/nodes.svg``: the graph of nodes, each once, with a numbered list of interfaces below it.

SVG 1.1 without scripts, styles or external fonts. Commands run from left to right: nodes, controllers, devices.
Feedback runs from right to left and is drawn lighter. Interfaces between the same ends share an arrow and its number in
the list. Vendor control and physical safety are boundaries of their own, drawn bold. Dashed is of what something is
UNKNOWN. Left out: interfaces that no node of the cell uses, and the contract of each arrow, which
``graph/responsibility.svg`` has.
"""

from __future__ import annotations

import textwrap
from collections.abc import Container, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import NodeSource
from cellc.compiler.deploy.arrows import ArrowKind, drives, exchanges, helpers, stop, unknown_boxes
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.formats.escape import one_line
from cellc.compiler.formats.layered import Box, Columns, Layout, Line, Point, layout
from cellc.compiler.formats.svg import arrow_head, name_lines, rectangle, sheet, text
from cellc.compiler.formats.xml_text import element, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN

_SIZE, _LINE = 13, 17  # height of letters, and of a line of text
_BOX, _CHARACTERS = 126, 17  # width of a box, and how many characters it holds
_GAP = 84  # between two layers, where lines cross
_MARGIN, _TITLE = 14, 50
_CROWDED = 4  # arrows for each end above which they go through a box of their own
_BAND = 20  # between a box and the boundary around it
_INK, _BACK, _STOP = "#30363d", "#3d6d9c", "#b3310a"
_MOVE, _HELP = "#6b3fa0", "#8a949e"
_DASHED = {"stroke-dasharray": "6 4"}


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the picture."""
    yield Artifact("graph/nodes.svg", render(_sheet(graph.cell), plan.header.text))


@dataclass(frozen=True, slots=True)
class Exchange:
    """Interfaces of one kind between the same ends, which share an arrow; data or goals go from starts to ends."""

    kind: ArrowKind
    starts: tuple[str, ...]
    ends: tuple[str, ...]
    is_unknown: bool
    names: tuple[str, ...]

    @property
    def hub(self) -> str:
        """Key of the box that its arrows go through where they would be many times its ends, and show nothing."""
        straight, through = len(self.starts) * len(self.ends), len(self.starts) + len(self.ends)
        return f"\n{self.names[0]}" if straight > _CROWDED * through else ""

    @property
    def commands(self) -> bool:
        """Whether it asks for something to be done."""
        return self.kind != "topic"


def _exchanges(cell: Cell) -> tuple[Exchange, ...]:
    found: dict[tuple[ArrowKind, tuple[str, ...], tuple[str, ...], bool], list[str]] = {}
    for arrow in exchanges(cell):
        if arrow.starts and arrow.ends:
            ends = tuple(dict.fromkeys(arrow.starts)), tuple(dict.fromkeys(arrow.ends))
            found.setdefault((arrow.kind, *ends, arrow.is_unknown), []).append(arrow.title)
    return tuple(Exchange(*key, tuple(names)) for key, names in found.items())


def _layers(cell: Cell, exchanges: Sequence[Exchange]) -> dict[str, int]:
    """Return the layer of each box: nodes by who commands whom, then controllers, devices and the stop."""
    controllers = {controller.label for controller in cell.controllers}
    devices = [device.name for device in cell.devices]
    every_end = dict.fromkeys(name for exchange in exchanges for name in (*exchange.starts, *exchange.ends))
    drivers = dict.fromkeys(device.control.driver.node for device in cell.devices if device.control.driver is not None)
    heard_of = {end.full_name for interface in cell.interfaces for end in (*interface.sources, *interface.sinks)}
    own = (node for node in cell.nodes if node.source is NodeSource.SPEC and node.full_name not in heard_of)
    silent = dict.fromkeys(node.name for node in own)
    nodes = [name for name in (every_end | drivers | silent) if name not in controllers and name not in devices]
    asks: dict[str, set[str]] = {name: set() for name in nodes}
    for exchange in exchanges:
        for end in exchange.ends if exchange.commands else ():
            asks.get(end, set()).update(name for name in exchange.starts if name in asks)
    depths = _depths(asks)
    layers = {name: depths[name] for name in nodes}
    asked = {name for exchange in exchanges if exchange.commands for name in (*exchange.starts, *exchange.ends)}
    heard_by: dict[str, list[tuple[str, ...]]] = {}
    for exchange in exchanges:
        for name in exchange.starts:
            heard_by.setdefault(name, []).append(exchange.ends)
    for name in nodes:
        ends_of = () if name in asked else heard_by.get(name, ())
        if heard := [layers[end] for ends in ends_of for end in ends if end in asks and end != name]:
            layers[name] = min(heard) - 1
    first = min(layers.values(), default=0)
    after = max(layers.values(), default=0) - first + 1
    beside = [*(controller.label for controller in cell.controllers), *(each.starts[0] for each in helpers(cell))]
    column = 1 if beside else 0
    found = {
        **{name: layer - first for name, layer in layers.items()},
        **dict.fromkeys(beside, after),
        **dict.fromkeys(devices, after + column),
        _stop(cell): after + column + 1,
    }
    return found | {exchange.hub: found[exchange.ends[0]] for exchange in exchanges if exchange.hub}


def _stop(cell: Cell) -> str:
    # A node may be called like the authority of the stop.
    return f"\n{cell.safety.stop.authority}"


def _depths(asks: Mapping[str, set[str]]) -> Mapping[str, int]:
    """Return how many nodes command one another before each."""
    others = {name: asked - {name} for name, asked in asks.items()}
    depths: dict[str, int] = {}
    try:
        for name in TopologicalSorter(others).static_order():
            depths[name] = max((depths[ask] + 1 for ask in others[name]), default=0)
    except CycleError:
        return {name: _depth(name, asks, ()) for name in asks}
    return depths


def _depth(name: str, asks: Mapping[str, set[str]], above: tuple[str, ...]) -> int:
    """Return how many nodes command one another before this one; a circle is cut where it closes."""
    inner = (*above, name)
    return max((_depth(ask, asks, inner) + 1 for ask in sorted(asks[name]) if ask not in inner), default=0)


def _arrows(cell: Cell, exchanged: Sequence[Exchange]) -> Iterator[tuple[Line, str, bool]]:
    """Yield every line with what kind it is, and whether something of it is UNKNOWN."""
    for order, one in enumerate(exchanged, start=1):
        if one.hub:
            pairs = [*((start, one.hub) for start in one.starts), *((one.hub, end) for end in one.ends)]
        else:
            pairs = [(start, end) for start in one.starts for end in one.ends if end != start]
        yield from ((Line(start, end, str(order)), "tells", one.is_unknown) for start, end in pairs)
    for arrow in (*drives(cell), *helpers(cell)):
        yield Line(arrow.starts[0], arrow.ends[0], arrow.kind), arrow.kind, arrow.is_unknown
    for arrow in stop(cell):
        yield from ((Line(_stop(cell), end, arrow.kind), arrow.kind, arrow.is_unknown) for end in arrow.ends)


def _sheet(cell: Cell) -> Element:
    exchanged = _exchanges(cell)
    layers = _layers(cell, exchanged)
    count = max(layers.values()) + 1
    columns = Columns(tuple(_BAND * 1.5 + layer * (_BOX + _GAP) for layer in range(count)), _BOX)
    arrows = tuple(_arrows(cell, exchanged))
    boxes = [Box(key, layer, len(name_lines(key, _CHARACTERS)) * _LINE + 9.0) for key, layer in layers.items()]
    placed = layout(boxes, [line for line, _, _ in arrows], columns)
    width = columns.lefts[-1] + _BOX + _BAND * 1.5
    bottom = _MARGIN + _TITLE + placed.height + _MARGIN
    listed, below = _list(exchanged, width, bottom + 2 * _MARGIN + _LINE)
    graph = [*_lines(arrows, placed, layers), *_boxes(placed, layers, columns, unknown_boxes(cell))]
    heads = (("ink", _INK), ("back", _BACK), ("stop", _STOP))
    drawn = [
        element("defs", children=[arrow_head(*head) for head in heads]),
        *_bands(cell, layers, columns, bottom),
        element("g", {"transform": f"translate(0 {_MARGIN + _TITLE})"}, graph),
        *_legend(bottom + _MARGIN + 6, {kind for _, kind, _ in arrows}),
        *listed,
    ]
    return sheet(f"Node graph of {cell.name}", width, below, _SIZE, drawn)


def _bands(cell: Cell, layers: Mapping[str, int], columns: Columns, bottom: float) -> Iterator[Element]:
    """Draw the boundaries: what software of the cell is, what the vendor's control is, and what stops physically."""
    owners = cell.owners.responsibilities
    last = layers[_stop(cell)]
    titles = (
        (0, last - 2, "ROS 2 graph", ""),
        (last - 1, last - 1, "Vendor control", f"owner {owners.vendor_safety}"),
        (last, last, "Physical safety", f"owner {owners.physical_stop}"),
    )
    for first, end, title, owner in titles:
        left, right = columns.lefts[first] - _BAND, columns.lefts[end] + columns.width + _BAND
        line = {"rx": "6", "fill": "none", "stroke": "#000000", "stroke-width": "4" if owner else "1"}
        line |= _DASHED if UNKNOWN in owner else {}
        yield rectangle(left, _MARGIN / 2, right - left, bottom - _MARGIN / 2, line)
        yield text(left + 12, _MARGIN + 16, title, {"font-weight": "bold"})
        yield text(left + 12, _MARGIN + 32, owner)


_HALO = {"stroke": "#ffffff", "stroke-width": "3", "paint-order": "stroke"}
_STYLES = {
    "tells": {"stroke": _INK, "stroke-width": "1.2", "marker-end": "url(#ink)"},
    "back": {"stroke": _BACK, "stroke-width": "1.2", "marker-end": "url(#back)"},
    "claims": {"stroke": _INK, "stroke-width": "3"},
    "moves": {"stroke": _MOVE, "stroke-width": "3"},
    "helps": {"stroke": _HELP, "stroke-width": "2"},
    "stops": {"stroke": _STOP, "stroke-width": "3", "marker-end": "url(#stop)"},
    "unknown": {"stroke": _INK, "stroke-width": "1.2"} | _DASHED,
}


def _lines(arrows: Sequence[tuple[Line, str, bool]], placed: Layout, layers: Mapping[str, int]) -> Iterator[Element]:
    numbers: dict[Point, tuple[str, str, bool]] = {}
    for (line, kind, is_unknown), route in zip(arrows, placed.routes, strict=True):
        back = kind == "tells" and layers[line.end] <= layers[line.start]
        style = _STYLES["back" if back else kind] | (_DASHED if is_unknown else {})
        yield element("path", {"d": _path(route), "fill": "none"} | style)
        if kind == "tells":
            for at, towards in ((route[0], route[1]), (route[-1], route[-2])):
                right = towards[0] > at[0] or (layers[line.start] == layers[line.end])
                numbers[at] = (line.group, _BACK if back else _INK, right)
    for (x, y), (number, color, right) in numbers.items():
        beside = {"font-size": "10", "fill": color, "text-anchor": "start" if right else "end"} | _HALO
        yield text(x + (9 if right else -9), y - 2, number, beside)


def _path(route: Sequence[Point]) -> str:
    """Return a way that leaves and enters boxes level, and crosses layers straight."""
    (x, y), *rest = route
    pieces = [f"M{x:g} {y:g}"]
    for number, (x2, y2) in enumerate(rest):
        if number % 2:
            pieces.append(f"H{x2:g}")
        elif x == x2:  # both in one layer: out and back
            pieces.append(f"C{x + 44:g} {y:g} {x + 44:g} {y2:g} {x2:g} {y2:g}")
        else:
            middle = (x + x2) / 2
            pieces.append(f"C{middle:g} {y:.1f} {middle:g} {y2:.1f} {x2:g} {y2:.1f}")
        x, y = x2, y2
    return "".join(pieces)


def _boxes(placed: Layout, layers: Mapping[str, int], columns: Columns, unknown: Container[str]) -> Iterator[Element]:
    for key, (center, height) in placed.boxes.items():
        left = columns.lefts[layers[key]]
        outline = {"rx": "5", "fill": "#eef2f7", "stroke": "#51606f"} | (_DASHED if key.strip() in unknown else {})
        yield rectangle(left, center - height / 2, columns.width, height, outline)
        lines = name_lines(key, _CHARACTERS)
        first = center - (len(lines) - 1) * _LINE / 2 + _SIZE / 3
        for order, line in enumerate(lines):
            yield text(left + columns.width / 2, first + order * _LINE, line, {"text-anchor": "middle"})


def _legend(y: float, drawn: Container[str]) -> Iterator[Element]:
    """Say what each kind of line is that is drawn."""
    x = float(_MARGIN)
    words = {
        "tells": "publishes, requests",
        "back": "returns data",
        "claims": "claims",
        "moves": "moves without a controller",
        "helps": "helps",
        "stops": "stops",
        "unknown": "UNKNOWN",
    }
    for kind, said in words.items():
        if kind not in drawn and kind not in ("back", "unknown"):
            continue
        yield element("path", {"d": f"M{x:g} {y - 4:g}h34", "fill": "none"} | _STYLES[kind])
        yield text(x + 42, y, said)
        x += 60 + len(said) * 7.5


def _list(exchanges: Sequence[Exchange], width: float, top: float) -> tuple[list[Element], float]:
    """Return the list of what each number carries in two columns, and where the sheet ends."""
    room = int((width / 2 - 2 * _MARGIN - 26) / 7.2)
    entries = [(str(number), _said(exchange, room)) for number, exchange in enumerate(exchanges, start=1)]
    total = sum(len(lines) for _, lines in entries)
    drawn, row, column = [], 0, 0
    deepest = 0
    for number, lines in entries:
        if column == 0 and row * 2 >= total:
            row, column = 0, 1
        x = _MARGIN + column * width / 2
        y = top + row * _LINE
        drawn.append(text(x + 20, y, number, {"text-anchor": "end", "font-weight": "bold"}))
        drawn += [text(x + 28, y + index * _LINE, line) for index, line in enumerate(lines)]
        row += len(lines)
        deepest = max(deepest, row)
    return drawn, top + deepest * _LINE + _MARGIN / 2


def _said(one: Exchange, room: int) -> list[str]:
    return textwrap.wrap(", ".join(map(one_line, one.names)), room, break_long_words=True, break_on_hyphens=False)
