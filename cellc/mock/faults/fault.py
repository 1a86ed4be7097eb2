"""What a fault is."""

from __future__ import annotations

from typing import Protocol

from cellc.mock.plant import Plant


class Fault(Protocol):
    """Something that goes wrong in a running cell; ``begin`` and ``end`` are called at their times."""

    def begin(self, plant: Plant) -> None:
        """Let it go wrong from now on."""
        ...

    def end(self, plant: Plant) -> None:
        """Let it be right again, for a fault that lasts."""
        ...
