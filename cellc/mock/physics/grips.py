"""Whether finger pads hold a part by friction, and what it is too much of where they do not."""

from __future__ import annotations

from collections.abc import Container

from cellc.contract.frozen import dataclass
from cellc.mock.physics.dynamics import Dynamics

DRY = 0.5
"""Friction of most dry surfaces, and what a spec has that states none: what it would hold is not too heavy."""


@dataclass(frozen=True, slots=True)
class Grip:
    """Pads that press on a part.

    Attributes:
        pads_n: with which all pads press together, along their normals.
        friction: of their contacts with the part.
        weight_n: of the part.
    """

    part: str
    pads_n: float
    friction: float
    weight_n: float

    @property
    def holds_n(self) -> float:
        """What the pads carry at most (Coulomb): the friction of each times its force."""
        return self.friction * self.pads_n

    @property
    def weakness(self) -> str:
        """What the part is too much of to be held; empty where it is held, or nothing presses on it."""
        if self.holds_n >= self.weight_n or not self.pads_n:
            return ""
        return "too heavy" if DRY * self.pads_n < self.weight_n else "too slippery"

    def __str__(self) -> str:
        held = f"finger pads hold {self.holds_n:.3g} N of the {self.weight_n:.3g} N that {self.part} weighs"
        return f"{held}: they press with {self.pads_n:.3g} N at a friction of {self.friction:.2g}"


def grip_on(dynamics: Dynamics, part: str, fingers: Container[str]) -> Grip:
    """Return how fingers press on a part now."""
    pads_n = sum(touch.force_n for touch in dynamics.touches() if touch.is_between(part, fingers))
    return Grip(part, pads_n, dynamics.friction(part), dynamics.weight_n(part))
