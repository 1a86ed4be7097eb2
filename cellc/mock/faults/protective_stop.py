"""A device goes into protective stop: its state stays visible, commands are refused."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.control import ControllerManager
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class ProtectiveStop:
    """Stops the hardware component of a device."""

    component: str

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
