"""What every entity of a cell carries: its name and the place where the user wrote it."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.diagnostics import Span, YamlPath


@dataclass(frozen=True, slots=True, kw_only=True)
class Entity:
    """A named thing of the cell.

    Args:
        name: name in the ROS graph, prefix applied.
        path: where the spec speaks of it; for a derived thing, the path of what it was derived from.
        span: the place of ``path`` in the user's files.
    """

    name: str
    path: YamlPath
    span: Span
