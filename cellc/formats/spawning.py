"""Which controllers are spawned together: all of a manager in the order of the spec, on each target that has them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.control import Controller, ControllerManager


@dataclass(frozen=True, slots=True)
class Spawning:
    """What one spawner loads and configures, and what is activated of it; alternates are never.

    Args:
        controllers: all that the spawner is given.
        observing: those to activate that read states and claim nothing.
        claiming: those to activate that claim command interfaces.
        mock_alone: their hardware is a component on the mock; on real hardware the driver's own node moves the device,
            and a spawner would fail there.
    """

    controllers: tuple[str, ...]
    observing: tuple[str, ...]
    claiming: tuple[str, ...]
    mock_alone: bool


def spawnings(cell: Cell, manager: ControllerManager) -> Iterator[Spawning]:
    """Yield what the spawners of a manager are given, in order; the first failure in a list stops the rest of it."""
    for mock_alone in (False, True):
        controllers = [one for one in manager.controllers if on_the_mock_alone(cell, one) is mock_alone]
        if controllers:
            active = [one for one in controllers if one.active]
            yield Spawning(
                tuple(one.name for one in controllers),
                tuple(one.name for one in active if not one.command_interfaces),
                tuple(one.name for one in active if one.command_interfaces),
                mock_alone,
            )


def on_the_mock_alone(cell: Cell, controller: Controller) -> bool:
    """Tell whether a controller has its hardware on the mock and not in the real description."""
    if controller.device is None:
        return False
    hardware = cell.device(controller.device).hardware
    return hardware is not None and "real" not in hardware.targets
