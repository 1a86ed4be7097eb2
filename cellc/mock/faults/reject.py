"""A controller is inactive when its goal arrives."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Reject:
    """Deactivates a controller."""

    controller: str

    def begin(self, plant: Plant) -> None:
        """Deactivate it with the next update cycle."""
        plant.control.manager_of(self.controller).switch_controllers([], [self.controller])

    def end(self, plant: Plant) -> None:
        """Activate it again."""
        plant.control.manager_of(self.controller).switch_controllers([self.controller], [])
