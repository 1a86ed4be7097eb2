"""What a simulator takes in the place of figures that nothing states: of a part by its grasp, and of what moves."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.frame import FRICTION, Grasp
from cellc.contract.transforms import Vector3

EDGE_M = 0.05
DENSITY_KG_M3 = 1000.0
_DIGITS = 12
LIGHT_KG = 0.001
"""What a body weighs that moves and of which no mass is stated: none at all is refused."""


def edges_m(grasp: Grasp) -> Vector3:
    """Return the edges of the box: those that are stated, else of a cube as wide as fingers meet it."""
    edge = grasp.width_m or EDGE_M
    return grasp.size_m or (edge, edge, edge)


def mass_kg(grasp: Grasp) -> float:
    """Return the mass that is stated, or that of as much water."""
    x, y, z = edges_m(grasp)
    return grasp.mass_kg or round(DENSITY_KG_M3 * x * y * z, _DIGITS)


def assumed(grasp: Grasp) -> Iterator[str]:
    """Yield what of a part is not stated, with what is taken in its place."""
    if grasp.size_m is None:
        yield f"its size, as a cube of {grasp.width_m or EDGE_M:g} m"
    if not grasp.mass_kg:
        yield "its mass, as of water"
    if grasp.friction is None:
        yield f"its friction, {FRICTION:g}"
