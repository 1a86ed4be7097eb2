"""The catalogue's kind behind a controller: what it declares, whatever its plugin is called."""

from __future__ import annotations

from cellc.catalog.controller_kind import ControllerKind
from cellc.cell.cell import Cell
from cellc.cell.control import Controller


def kind_of(cell: Cell, controller: Controller) -> ControllerKind | None:
    """Return the kind of a controller: a neutral one, or what its device says of a passive one."""
    return controller.declared


def plugin_parameters(cell: Cell, controller: Controller) -> frozenset[str]:
    """Name the parameters that a vendor's plugin has besides those of the kind."""
    return controller.plugin_parameters
