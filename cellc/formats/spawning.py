"""Which controllers are spawned together: all of a manager in the order of the spec, on each target that has them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.control import Controller, ControllerManager
from cellc.cell.interface import TARGETS


@dataclass(frozen=True, slots=True)
class Spawning:
    """What one spawner loads and configures, and what is activated of it; alternates are never.

    Args:
        controllers: all that the spawner is given.
        observing: those to activate that read states and claim nothing.
        claiming: those to activate that claim command interfaces.
        only: the one target on which they are spawned; None for every target. On the others their hardware is no
            component, or lacks what they need, and a spawner would fail.
    """

    controllers: tuple[str, ...]
    observing: tuple[str, ...]
    claiming: tuple[str, ...]
    only: str | None

    def on(self, target: str) -> bool:
        """Tell whether it is started on a target."""
        return self.only in (None, target)


def spawnings(manager: ControllerManager) -> Iterator[Spawning]:
    """Yield what the spawners of a manager are given, in order; the first failure in a list stops the rest of it."""
    for only in (None, *TARGETS):
        controllers = [one for one in manager.controllers if only_target(one) == only]
        if controllers:
            active = [one for one in controllers if one.active]
            yield Spawning(
                tuple(one.name for one in controllers),
                tuple(one.name for one in active if not one.command_interfaces),
                tuple(one.name for one in active if one.command_interfaces),
                only,
            )


def only_target(controller: Controller) -> str | None:
    """Return the one target on which a controller is spawned, or None for one that is spawned on every target."""
    return controller.targets[0] if len(controller.targets) == 1 else None
