"""Two times of a cell of which item bounds the other, and what finds them."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.interface import Interface
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import InterfaceKind


@dataclass(frozen=True, slots=True)
class Pair:
    """A time or rate of the cell with its bound, both in the unit of the row.

    Args:
        path: where the finding goes: what the user wrote, else what the user should write.
        subject: what is bounded.
        because: what the bound follows from.
        places: further values of the spec that enter, each with what it is.
    """

    path: YamlPath
    subject: str
    value: float
    bound: float
    because: str
    places: tuple[tuple[str, YamlPath], ...] = ()


def topics_of(cell: Cell) -> Iterator[Interface]:
    return (item for item in cell.interfaces if item.kind is InterfaceKind.TOPIC)


def controllers_of(cell: Cell) -> Iterator[tuple[ControllerManager, Controller]]:
    return ((manager, controller) for manager in cell.managers for controller in manager.controllers)


def cycles_hz(manager: ControllerManager, controller: Controller) -> float:
    return controller.update_rate_hz or manager.update_rate_hz


def rate_path(cell: Cell, manager: ControllerManager, controller: Controller) -> YamlPath:
    own = (*controller.path, "update_rate")
    return own if cell.states(*own) else (*manager.path, "update_rate")


def parameter_of(cell: Cell, controller: Controller, name: str) -> object:
    """Return a parameter as the controller gets it, or its default."""
    declared = {} if controller.declared is None else controller.declared.parameters
    if name in controller.parameters or name not in declared:
        return controller.parameters.get(name)
    return declared[name].as_in(cell.distro).default if declared[name].declared_in(cell.distro) else None


def number_of(value: object) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def shown(time_s: float) -> str:
    return f"{time_s:g} s" if time_s >= 1.0 else f"{time_s * 1e3:.4g} ms"
