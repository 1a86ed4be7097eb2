"""How rules sort and name what touches."""

from __future__ import annotations

from collections.abc import Sequence

from cellc.feasibility import BodyContact
from cellc.graph.cell_graph import CellGraph


def with_scene(graph: CellGraph, contacts: Sequence[BodyContact]) -> list[BodyContact]:
    """Return the contacts with a box of the scene."""
    boxes = {box.name for box in graph.cell.scene}
    return [contact for contact in contacts if contact.first in boxes or contact.second in boxes]


def within_robot(graph: CellGraph, contacts: Sequence[BodyContact]) -> list[BodyContact]:
    """Return the contacts of links with links."""
    others = with_scene(graph, contacts)
    return [contact for contact in contacts if contact not in others]


def named(contacts: Sequence[BodyContact]) -> str:
    """Name the first contact, and say how many more there are."""
    more = f", and {len(contacts) - 1} more such pairs" if len(contacts) > 1 else ""
    return f"`{contacts[0].first}` and `{contacts[0].second}` touch{more}"
