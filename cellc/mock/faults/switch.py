"""Somebody switches controllers: as a declared switch says, or one controller off and on again.

A switch in motion aborts the goal of the controller that is deactivated; its commands stay at their last values until
the next owner claims them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.contents import controllers
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Switch:
    """Asks a controller manager for one strict switch."""

    manager: str
    activate: tuple[str, ...]
    deactivate: tuple[str, ...]

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Switch | None:
        """Return the fault of an entry; None where its target is neither a switch nor a controller."""
        for name, manager in contract.managers.items():
            if entry.target in manager.switches:
                switch = manager.switches[entry.target]
                return cls(name, switch.activate, switch.deactivate)
            if entry.target in manager.controllers:
                return cls(name, (entry.target,), (entry.target,))
        return None

    def begin(self, plant: Plant) -> None:
        """Switch."""
        plant.control.managers[self.manager].switch_controllers(self.activate, self.deactivate)

    def end(self, plant: Plant) -> None:
        """Switch back; a controller that was restarted is back already."""
        if self.activate != self.deactivate:
            plant.control.managers[self.manager].switch_controllers(self.deactivate, self.activate)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every declared switch, and the restart of every controller that takes goals."""
    for manager in contract.managers.values():
        for name, switch in manager.switches.items():
            entry = FaultEntry(kind="switch", target=name)
            yield fault_case(entry, contract, partial(_ending, Bounds(contract), switch.deactivate))
    for name, facts in controllers(contract).items():
        if facts.active and facts.action is not None:
            entry = FaultEntry(kind="switch", target=name)
            yield fault_case(entry, contract, partial(_ending, Bounds(contract), (name,)))


def _ending(bounds: Bounds, deactivated: tuple[str, ...], step: CellStep) -> Ending:
    """A switch between two goals, or one that is refused, is borne; after it a goal may meet an inactive controller."""
    if not set(deactivated) & set(step.controllers):
        return BORNE
    return ends_in("wrong_owner", "goal_rejection", SUCCEEDED, within_s=bounds.asked_s())
