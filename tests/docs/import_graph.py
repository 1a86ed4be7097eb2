"""Draws which rooms of the wings of cellc import which, without what follows from the rest: docs/import_graph.svg.

`python -m tests.docs.import_graph` draws it again after a folder came or went, or imports another.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import grimp
import networkx as nx

from tests.cells import ROOT

PICTURE = ROOT / "docs" / "import_graph.svg"
_BOX, _HEIGHT, _ROW, _LANE, _MARGIN = 104, 30, 62, 26, 20
_PAINT = 'rx="4" fill="#eef3f8" stroke="#33567d"'
_SWEEPS = 12

# A node is the name of a folder, or a lane: an edge on its way past a row.
_Lane = tuple[str, str, int]
_Node = str | _Lane


def imports() -> nx.DiGraph[str]:
    """Return the rooms of the wings, with an edge from each to what it imports itself."""
    found = grimp.build_graph("cellc", exclude_type_checking_imports=True)
    graph: nx.DiGraph[str] = nx.DiGraph()
    for module in sorted(found.modules):
        room = _room(module, found)
        imported = {_room(other, found) for other in found.find_modules_directly_imported_by(module)}
        graph.add_edges_from((room, other) for other in sorted(imported - {room, ""}) if room)
    return graph


def _room(module: str, found: grimp.ImportGraph) -> str:
    """Return the folder or module of a wing that a module is in; what is shared in files of its own is one room."""
    _, *path = module.split(".")
    if len(path) < 2 and path != ["mock"]:
        return ""  # the package itself, its version and its `python -m`, and wings, which import nothing
    wing, *within = path
    alone = wing == "mock" or (wing == "contract" and not found.find_children(f"cellc.contract.{within[0]}"))
    return wing if alone else within[0]


def picture() -> str:
    """Return the drawing as SVG: who imports stands above whom it imports."""
    graph: nx.DiGraph[str] = nx.transitive_reduction(imports())
    rows = _rows(graph)
    places = {node: place for place, node in _placed(rows)}
    width = max(x for x, _ in places.values()) + _BOX // 2 + _MARGIN
    height = _MARGIN * 2 + _ROW * (len(rows) - 1) + _HEIGHT
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}"',
        '     font-family="sans-serif" font-size="13">',
        "  <title>Rooms of cellc: each imports what it has a line down to, and what that imports</title>",
        f'  <rect width="{width}" height="{height}" fill="white"/>',
    ]
    lines += [f'  <path d="{_curve(edge, places)}" fill="none" stroke="#8a8a8a"/>' for edge in sorted(graph.edges)]
    for node in sorted(graph):
        x, y = places[node]
        lines += [
            f'  <rect x="{x - _BOX // 2}" y="{y}" width="{_BOX}" height="{_HEIGHT}" {_PAINT}/>',
            f'  <text x="{x}" y="{y + 20}" text-anchor="middle">{node}</text>',
        ]
    return "\n".join([*lines, "</svg>", ""])


def _rows(graph: nx.DiGraph[str]) -> list[list[_Node]]:
    """Return rows from top to bottom, with lanes for edges that pass a row, ordered so that few lines cross."""
    rows: list[list[_Node]] = [sorted(row) for row in nx.topological_generations(graph)]
    row_of = {node: number for number, row in enumerate(rows) for node in row}
    neighbors: dict[_Node, list[_Node]] = {node: [] for row in rows for node in row}
    for edge in sorted(graph.edges):
        way = list(_way(edge, row_of[edge[0]], row_of[edge[1]]))
        for number, lane in enumerate(way[1:-1], row_of[edge[0]] + 1):
            rows[number].append(lane)
            neighbors[lane] = []
        for upper, lower in pairwise(way):
            neighbors[upper].append(lower)
            neighbors[lower].append(upper)
    for _ in range(_SWEEPS):
        for sweep in (rows[1:], rows[-2::-1]):
            for row in sweep:
                position = {node: index / len(each) for each in rows for index, node in enumerate(each)}
                row.sort(key=lambda node: (_mean([position[other] for other in neighbors[node]]), str(node)))
    return rows


def _way(edge: tuple[str, str], first: int, last: int) -> Iterator[_Node]:
    yield edge[0]
    yield from ((*edge, number) for number in range(first + 1, last))
    yield edge[1]


def _mean(values: list[float]) -> float:
    return sum(values) / len(values) if values else 0.0


def _placed(rows: list[list[_Node]]) -> Iterator[tuple[tuple[int, int], _Node]]:
    """Yield the middle of the upper edge of every node; rows are centred on the widest."""
    widest = max(_width(row) for row in rows)
    for number, row in enumerate(rows):
        x = _MARGIN + (widest - _width(row)) // 2
        for node in row:
            room = _BOX + _LANE if isinstance(node, str) else _LANE
            yield (x + room // 2, _MARGIN + number * _ROW), node
            x += room


def _width(row: list[_Node]) -> int:
    return sum(_BOX + _LANE if isinstance(node, str) else _LANE for node in row)


def _curve(edge: tuple[str, str], places: dict[_Node, tuple[int, int]]) -> str:
    lanes = sorted((node for node in places if isinstance(node, tuple) and node[:2] == edge), key=lambda lane: lane[2])
    x, y = places[edge[0]]
    path, last = f"M {x} {y + _HEIGHT}", y + _HEIGHT
    for lane in lanes:
        left, top = places[lane]
        middle = (last + top) // 2
        path += f" C {x} {middle} {left} {middle} {left} {top} V {top + _HEIGHT}"
        x, last = left, top + _HEIGHT
    end, top = places[edge[1]]
    middle = (last + top) // 2
    return f"{path} C {x} {middle} {end} {middle} {end} {top}"


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
