"""What one spawner loads and configures, by target."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.contract.entities import TARGETS
from cellc.contract.frozen import dataclass


@dataclass(frozen=True, slots=True)
class Spawning:
    """What one spawner loads and configures; alternates too.

    Args:
        controllers: all that the spawner is given.
        only: the one target on which they are spawned; None for every target. On the others their hardware is no
            component, or lacks what they need, and a spawner would fail.
    """

    controllers: tuple[str, ...]
    only: str | None


def spawnings(manager: ControllerManager) -> Iterator[Spawning]:
    """Yield what the spawners of a manager are given, in order; the first failure in a list stops the rest of it."""
    for only in (None, *TARGETS):
        controllers = tuple(controller.name for controller in manager.controllers if _only_target(controller) == only)
        if controllers:
            yield Spawning(controllers, only)


def _only_target(controller: Controller) -> str | None:
    """Return the one target on which a controller is spawned, or None for one that is spawned on every target."""
    return controller.targets[0] if len(controller.targets) == 1 else None
