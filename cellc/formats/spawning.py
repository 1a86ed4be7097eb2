"""Which controllers are spawned together: the order of the spec, alternates apart, each on the targets that have it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.control import Controller, ControllerManager


@dataclass(frozen=True, slots=True)
class Spawning:
    """What one spawner is given.

    Args:
        inactive: the controllers are loaded and configured, not activated.
        mock_alone: their hardware is a component on the mock; on real hardware the driver's own node moves the device,
            and a spawner would fail there.
    """

    controllers: tuple[str, ...]
    inactive: bool
    mock_alone: bool


def spawnings(cell: Cell, manager: ControllerManager) -> Iterator[Spawning]:
    """Yield what the spawners of a manager are given, in order; the first failure in a list stops the rest of it."""
    for mock_alone in (False, True):
        for inactive in (False, True):
            names = tuple(
                one.name
                for one in manager.controllers
                if one.active is not inactive and _on_the_mock_alone(cell, one) is mock_alone
            )
            if names:
                yield Spawning(names, inactive, mock_alone)


def _on_the_mock_alone(cell: Cell, controller: Controller) -> bool:
    if controller.device is None:
        return False
    hardware = cell.device(controller.device).hardware
    return hardware is not None and "real" not in hardware.targets
