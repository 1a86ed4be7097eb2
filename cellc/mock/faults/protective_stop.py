"""A device goes into protective stop: its state stays visible, commands are refused."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.control import ControllerManager
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import FaultCase, ends_in, fault_case
from cellc.mock.faults.contents import components
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class ProtectiveStop:
    """Stops the hardware component of a device."""

    component: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> ProtectiveStop | None:
        """Return the fault of an entry; None where its target has no hardware."""
        component = components(contract).get(entry.target)
        return None if component is None else cls(component)

    def begin(self, plant: Plant) -> None:
        """Stop."""
        for manager in self._managers(plant):
            manager.disturbances.protective_stop(self.component)

    def end(self, plant: Plant) -> None:
        """Release the device; its controllers stay inactive until someone activates them."""
        for manager in self._managers(plant):
            manager.disturbances.release(self.component)

    def _managers(self, plant: Plant) -> list[ControllerManager]:
        managers = plant.control.managers.values()
        return [
            manager
            for manager in managers
            if any(component.name == self.component for component in manager.list_hardware_components())
        ]


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every device with hardware; a stop ends whatever step it meets."""
    stopped = ends_in("protective_stop", within_s=Bounds(contract).hold_s())
    for device in components(contract):
        yield fault_case(FaultEntry(kind="protective_stop", target=device), contract, lambda step: stopped)
