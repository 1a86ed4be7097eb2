"""A goal moves out of the reach of its group."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant

DISTANCE_M = 10.0
"""Farther than any arm of a cell reaches."""


@dataclass(frozen=True, slots=True)
class Unreachable:
    """Displaces a goal along the z axis of its frame."""

    goal: str

    def begin(self, plant: Plant) -> None:
        """Displace it."""
        plant.requests.displaced[self.goal] = (0.0, 0.0, DISTANCE_M)

    def end(self, plant: Plant) -> None:
        """Put it back."""
        plant.requests.displaced.pop(self.goal, None)
