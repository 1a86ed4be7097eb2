"""A sensor repeats its last sample with its old stamp."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Freeze:
    """Freezes the stream of a device."""

    device: str

    def begin(self, plant: Plant) -> None:
        """Repeat the last image from now on."""
        plant.cameras[self.device].frozen = True

    def end(self, plant: Plant) -> None:
        """Stream again."""
        plant.cameras[self.device].frozen = False
