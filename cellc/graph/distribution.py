"""What the catalogue knows of the cell's ROS 2 distribution."""

from __future__ import annotations

from cellc.catalog.load import load_distros
from cellc.catalog.tables import DistroFacts
from cellc.cell.cell import Cell


def distribution(cell: Cell) -> DistroFacts | None:
    """Return the facts of the pinned distribution, or None where the catalogue has none."""
    table = load_distros().value
    known = {} if table is None else dict(table.distros.items())
    return next((facts for name, facts in known.items() if name == cell.distro), None)
