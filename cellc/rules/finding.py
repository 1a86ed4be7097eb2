"""How a check writes a finding at a path of the spec."""

from __future__ import annotations

from cellc.diagnostics import Related, YamlPath
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding


def found(
    graph: CellGraph, path: YamlPath, message: str, help_text: str = "", related: tuple[Related, ...] = ()
) -> Finding:
    """Report something at a path, or at its nearest ancestor where the path is what is missing."""
    return Finding(message, graph.cell.locate(*path), path, help_text, related)
