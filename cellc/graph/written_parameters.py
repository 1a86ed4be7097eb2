"""Controller parameters that the user wrote, apart from those that follow from the kind of controller."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.control import Controller
from cellc.cell.interface import ParameterValue
from cellc.diagnostics import YamlPath


@dataclass(frozen=True, slots=True)
class WrittenParameter:
    """One parameter with the controller that it goes to and the place where it is written."""

    controller: Controller
    name: str
    value: ParameterValue
    path: YamlPath


def written_parameters(cell: Cell) -> Iterator[WrittenParameter]:
    """Yield every parameter under ``parameters:`` of a controller."""
    for controller in cell.controllers:
        for name, value in controller.written_parameters.items():
            yield WrittenParameter(controller, name, value, (*controller.path, "parameters", name))
