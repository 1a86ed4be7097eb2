"""A joint no longer follows its command."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Stick:
    """Holds a joint where it is."""

    joint: str

    def begin(self, plant: Plant) -> None:
        """Stick."""
        for manager in plant.control.manager_of_joint(self.joint):
            manager.disturbances.stick(self.joint)

    def end(self, plant: Plant) -> None:
        """Follow again."""
        for manager in plant.control.manager_of_joint(self.joint):
            manager.disturbances.clear(self.joint)
