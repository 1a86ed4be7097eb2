"""Parts that grippers take, as free bodies; what the spec leaves open has a default that the file names."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from cellc.compiler.cell.frame import Grasp
from cellc.compiler.formats.mjcf.elements import numbers
from cellc.compiler.formats.mjcf.tree import Part
from cellc.compiler.formats.numbers import rounded, shortest
from cellc.compiler.formats.xml_text import element

EDGE_M = 0.05
DENSITY_KG_M3 = 1000.0
_COLOR = "0.85 0.55 0.2 1"


def part_elements(part: Part) -> tuple[Element, ...]:
    """Return what is in the body of a part: a cube as wide as fingers meet it, about its frame."""
    edge, mass = edge_m(part.grasp), mass_kg(part.grasp)
    moment = shortest(rounded(mass * edge**2 / 6.0))
    return (
        element("freejoint", {"name": f"{part.name}_free"}),
        element("inertial", {"pos": "0 0 0", "mass": shortest(mass), "diaginertia": " ".join([moment] * 3)}),
        element("geom", {"type": "box", "size": numbers([edge / 2.0] * 3), "rgba": _COLOR, "condim": "4"}),
    )


def edge_m(grasp: Grasp) -> float:
    """Return the edge of the cube."""
    return grasp.width_m or EDGE_M


def mass_kg(grasp: Grasp) -> float:
    """Return the mass that is stated, or that of as much water."""
    return grasp.mass_kg or rounded(DENSITY_KG_M3 * edge_m(grasp) ** 3)


def defaults_of(part: Part) -> str:
    """Return what of a part is not stated, as a line of the file."""
    grasp, taken = part.grasp, [f"a cube of {shortest(edge_m(part.grasp))} m about its frame"]
    if grasp.width_m is None:
        taken.append("its width")
    if grasp.mass_kg is None:
        taken.append("its mass, as of water")
    return f"frames, grasp: {part.name} is {' with '.join(taken[:1])}" + (
        f"; not stated: {', '.join(taken[1:])}" if taken[1:] else ""
    )
