"""Links of a URDF: inertia, shapes and colours."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.description.model import Box, Collision, Cylinder, Geometry, Inertial, Link, Mesh, Sphere, Visual
from cellc.description.urdf_values import number, numbers, origin_pose, refused, required, required_child, vector
from cellc.description.xml_tree import XmlElement

Rgba = tuple[float, float, float, float]


def read_link(element: XmlElement, colours: Mapping[str, Rgba]) -> Link:
    """Read one ``<link>``; ``colours`` are the materials that the robot names at its top level."""
    inertial = element.first("inertial")
    return Link(
        name=required(element, "name"),
        inertial=None if inertial is None else _read_inertial(inertial),
        visuals=tuple(_read_visual(visual, colours) for visual in element.all("visual")),
        collisions=tuple(_read_collision(collision) for collision in element.all("collision")),
        span=element.span,
    )


def _read_inertial(element: XmlElement) -> Inertial:
    mass, inertia = required_child(element, "mass"), required_child(element, "inertia")
    return Inertial(
        pose=origin_pose(element),
        mass=number(mass, "value"),
        ixx=number(inertia, "ixx"),
        ixy=number(inertia, "ixy"),
        ixz=number(inertia, "ixz"),
        iyy=number(inertia, "iyy"),
        iyz=number(inertia, "iyz"),
        izz=number(inertia, "izz"),
    )


def _read_collision(element: XmlElement) -> Collision:
    return Collision(element.attributes.get("name"), origin_pose(element), _read_geometry(element))


def _read_visual(element: XmlElement, colours: Mapping[str, Rgba]) -> Visual:
    material = element.first("material")
    name = None if material is None else material.attributes.get("name")
    rgba = colours.get(name) if name is not None else None
    colour = None if material is None else material.first("color")
    if colour is not None:
        r, g, b, a = numbers(colour, "rgba", 4)
        rgba = (r, g, b, a)
    return Visual(element.attributes.get("name"), origin_pose(element), _read_geometry(element), name, rgba)


def _read_geometry(element: XmlElement) -> Geometry:
    geometry = required_child(element, "geometry")
    if len(geometry.children) != 1:
        message = f"`<geometry>` holds {len(geometry.children)} shapes where one is due"
        raise refused("urdf-bad-geometry", geometry, message)
    shape = geometry.children[0]
    if shape.tag == "box":
        return Box(vector(shape, "size"))
    if shape.tag == "cylinder":
        return Cylinder(number(shape, "radius"), number(shape, "length"))
    if shape.tag == "sphere":
        return Sphere(number(shape, "radius"))
    if shape.tag == "mesh":
        scale = vector(shape, "scale") if "scale" in shape.attributes else (1.0, 1.0, 1.0)
        return Mesh(required(shape, "filename"), scale)
    help_text = "use `box`, `cylinder`, `sphere` or `mesh`"
    raise refused("urdf-bad-geometry", shape, f"`<{shape.tag}>` is not a shape of URDF", help_text)
