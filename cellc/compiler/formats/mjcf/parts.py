"""Parts that grippers take, as free bodies; what the spec leaves open has a default that the file names."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.compiler.cell.frame import FRICTION
from cellc.compiler.formats.mjcf.elements import numbers
from cellc.compiler.formats.mjcf.tree import Part
from cellc.compiler.formats.numbers import rounded, shortest
from cellc.compiler.formats.xml_text import element
from cellc.contract.transforms import Vector3

EDGE_M = 0.05
DENSITY_KG_M3 = 1000.0
_COLOR = "0.85 0.55 0.2 1"
_TURNING = "0.005 0.0001"
"""What MuJoCo has against turning about the normal of a contact, m, and against rolling, m."""
_HARD = {"solref": "0.004 1", "solimp": "0.99 0.99 0.001"}
"""A contact of MuJoCo is as soft as what touches is light: with its usual figures fingers sink in by a millimeter."""


def part_elements(part: Part) -> tuple[Element, ...]:
    """Return what is in the body of a part: a box about its frame, whose friction counts wherever it touches."""
    edges, mass = edges_m(part), mass_kg(part)
    x, y, z = (edge**2 for edge in edges)
    moments = (rounded(mass * squares / 12.0) for squares in (y + z, x + z, x + y))
    friction = f"{shortest(part.grasp.grips_with)} {_TURNING}"
    size = numbers(edge / 2.0 for edge in edges)
    surface = {"condim": "4", "friction": friction, "priority": "1", **_HARD}
    return (
        element("freejoint", {"name": f"{part.name}_free"}),
        element("inertial", {"pos": _center(part), "mass": shortest(mass), "diaginertia": numbers(moments)}),
        element("geom", {"type": "box", "pos": _center(part), "size": size, "rgba": _COLOR, **surface}),
    )


def edges_m(part: Part) -> Vector3:
    """Return the edges of the box: those that are stated, else as wide as fingers meet it, down to what it rests on."""
    edge = part.grasp.width_m or EDGE_M
    return part.grasp.size_m or (edge, edge, edge if part.above_m is None else rounded(edge / 2.0 + part.above_m))


def _center(part: Part) -> str:
    """Return where the center of the box is in its frame: below it where the part reaches down to what it rests on."""
    edge = part.grasp.width_m or EDGE_M
    reaches_down = part.grasp.size_m is None and part.above_m is not None
    return numbers((0.0, 0.0, rounded((edge / 2.0 - (part.above_m or 0.0)) / 2.0) if reaches_down else 0.0))


def mass_kg(part: Part) -> float:
    """Return the mass that is stated, or that of as much water."""
    x, y, z = edges_m(part)
    return part.grasp.mass_kg or rounded(DENSITY_KG_M3 * x * y * z)


def defaults_of(part: Part) -> str:
    """Return what a part is taken as, and what of it is not stated, as a line of the file."""
    x, y, z = (shortest(edge) for edge in edges_m(part))
    not_stated = ", ".join(assumed(part))
    return f"frames, grasp: {part.name} is a box of {x} by {y} by {z} m about its frame" + (
        f"; not stated: {not_stated}" if not_stated else ""
    )


def assumed(part: Part) -> Iterator[str]:
    """Yield what of a part is not stated, with what is taken in its place."""
    grasp = part.grasp
    if grasp.size_m is None and part.above_m is None:
        yield f"its size, as a cube of {shortest(grasp.width_m or EDGE_M)} m"
    elif grasp.size_m is None:
        yield "its size, so that it rests on what is below it"
    if not grasp.mass_kg:
        yield "its mass, as of water"
    if grasp.friction is None:
        yield f"its friction, {shortest(FRICTION)}"
