"""The update loops miss cycles."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class SkipCycles:
    """Lets every controller manager miss a number of cycles in a row."""

    cycles: int

    def begin(self, plant: Plant) -> None:
        """Miss them."""
        for manager in plant.control.managers.values():
            manager.disturbances.skip_cycles(self.cycles)

    def end(self, plant: Plant) -> None:
        """Nothing: a missed cycle stays missed."""
