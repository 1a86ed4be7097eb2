"""Parts that grippers take, as free bodies; what the spec leaves open has a default that the file names."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from cellc.compiler.formats.mjcf.elements import numbers
from cellc.compiler.formats.numbers import rounded, shortest
from cellc.compiler.formats.xml_text import element
from cellc.compiler.graph.part_figures import Part, assumed, center_m, edges_m, mass_kg

_COLOR = "0.85 0.55 0.2 1"
_TURNING = "0.005 0.0001"
"""What MuJoCo has against turning about the normal of a contact, m, and against rolling, m."""
_HARD = {"solref": "0.004 1", "solimp": "0.99 0.99 0.001"}
"""A contact of MuJoCo is as soft as what touches is light: with its usual figures fingers sink in by a millimeter."""


def part_elements(part: Part) -> tuple[Element, ...]:
    """Return what is in the body of a part: a box about its frame, whose friction counts wherever it touches."""
    edges, mass, center = edges_m(part), mass_kg(part), numbers((0.0, 0.0, center_m(part)))
    x, y, z = (edge**2 for edge in edges)
    moments = (rounded(mass * squares / 12.0) for squares in (y + z, x + z, x + y))
    friction = f"{shortest(part.grasp.grips_with)} {_TURNING}"
    size = numbers(edge / 2.0 for edge in edges)
    surface = {"condim": "4", "friction": friction, "priority": "1", **_HARD}
    return (
        element("freejoint", {"name": f"{part.name}_free"}),
        element("inertial", {"pos": center, "mass": shortest(mass), "diaginertia": numbers(moments)}),
        element("geom", {"type": "box", "pos": center, "size": size, "rgba": _COLOR, **surface}),
    )


def defaults_of(part: Part) -> str:
    """Return what a part is taken as, and what of it is not stated, as a line of the file."""
    x, y, z = (shortest(edge) for edge in edges_m(part))
    not_stated = ", ".join(assumed(part))
    return f"frames, grasp: {part.name} is a box of {x} by {y} by {z} m about its frame" + (
        f"; not stated: {not_stated}" if not_stated else ""
    )
