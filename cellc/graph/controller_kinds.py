"""The catalogue's kind behind a controller: what it declares, whatever its plugin is called."""

from __future__ import annotations

from cellc.catalog.controller_kind import ControllerKind
from cellc.catalog.kind_of import kind_behind
from cellc.cell.cell import Cell
from cellc.cell.control import Controller


def kind_of(cell: Cell, controller: Controller) -> ControllerKind | None:
    """Return the kind of a controller: a neutral one, or what its device says of a passive one."""
    return kind_behind(controller.kind, None if controller.device is None else cell.device(controller.device).facts)


def plugin_parameters(cell: Cell, controller: Controller) -> frozenset[str]:
    """Name the parameters that a vendor's plugin has besides those of the kind."""
    own = None if controller.device is None else cell.device(controller.device).facts.controllers.get(controller.kind)
    plugins = () if own is None else own.plugins.values()
    return frozenset(name for plugin in plugins for name in plugin.parameters)
