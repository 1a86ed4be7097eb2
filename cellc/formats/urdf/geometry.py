"""Poses and shapes as URDF elements."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Element

from cellc.description.model import Box, Collision, Cylinder, Geometry, Inertial, Mesh, Sphere, Visual
from cellc.formats.numbers import settled, shortest
from cellc.formats.xml_text import element
from cellc.transforms import Pose


def numbers(values: Iterable[float]) -> str:
    """Return numbers as an attribute holds them."""
    return " ".join(shortest(value) for value in values)


def origin(pose: Pose) -> tuple[Element, ...]:
    """Return ``<origin>`` in metres and fixed-axis roll, pitch, yaw, or nothing for the identity."""
    xyz = tuple(settled(value) for value in pose.position)
    rpy = tuple(settled(value) for value in pose.rpy())
    attributes = {name: numbers(values) for name, values in (("xyz", xyz), ("rpy", rpy)) if any(values)}
    return (element("origin", attributes),) if attributes else ()


def visual(shape: Visual, material: Iterable[Element]) -> Element:
    """Return ``<visual>``; ``material`` is its reference to a material of the robot, or nothing."""
    attributes = {} if shape.name is None else {"name": shape.name}
    return element("visual", attributes, [*origin(shape.pose), _geometry(shape.geometry), *material])


def collision(shape: Collision) -> Element:
    """Return ``<collision>``."""
    attributes = {} if shape.name is None else {"name": shape.name}
    return element("collision", attributes, [*origin(shape.pose), _geometry(shape.geometry)])


def inertial(body: Inertial) -> Element:
    """Return ``<inertial>``: kg and kg m^2 about the centre of mass."""
    tensor = {"ixx": body.ixx, "ixy": body.ixy, "ixz": body.ixz, "iyy": body.iyy, "iyz": body.iyz, "izz": body.izz}
    return element(
        "inertial",
        children=[
            *origin(body.pose),
            element("mass", {"value": shortest(body.mass)}),
            element("inertia", {name: shortest(value) for name, value in tensor.items()}),
        ],
    )


def _geometry(shape: Geometry) -> Element:
    return element("geometry", children=[_shape(shape)])


def _shape(shape: Geometry) -> Element:
    if isinstance(shape, Box):
        return element("box", {"size": numbers(shape.size)})
    if isinstance(shape, Cylinder):
        return element("cylinder", {"radius": shortest(shape.radius), "length": shortest(shape.length)})
    if isinstance(shape, Sphere):
        return element("sphere", {"radius": shortest(shape.radius)})
    assert isinstance(shape, Mesh)
    scale = {} if shape.scale == (1.0, 1.0, 1.0) else {"scale": numbers(shape.scale)}
    return element("mesh", {"filename": shape.filename} | scale)
