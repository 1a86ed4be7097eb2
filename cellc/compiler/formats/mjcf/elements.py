"""Links, joints, shapes and frames as MJCF elements, in m, kg, rad and unit quaternions, w first."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from xml.etree.ElementTree import Element

from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.formats.numbers import rounded, shortest
from cellc.compiler.formats.xml_text import comment, element
from cellc.compiler.graph.part_figures import LIGHT_KG
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, identity
from cellc.robot.description.model import Box, Cylinder, Geometry, Inertial, Joint, Link, Mesh, Sphere

_DIGITS = 12
"""Of a tensor that is turned: the figures that rounding leaves."""
_LOCKED = 1e-6
"""Width of the range of a joint that may not move, rad or m: a range of none is refused."""
_Tensor = tuple[tuple[float, float, float], ...]
Attributes = dict[str, str]


@dataclass(frozen=True, slots=True)
class Meshes:
    """Names of meshes in the file by name and scale of the description; ``missing`` has a reason for each left out."""

    names: Mapping[Mesh, str]
    missing: Mapping[str, str]


def numbers(values: Iterable[float]) -> str:
    """Return numbers as an attribute holds them."""
    return " ".join(shortest(value) for value in values)


def placement(pose: Pose) -> Attributes:
    """Return a pose as attributes, without what is zero."""
    x, y, z, w = pose.quaternion
    pos = tuple(rounded(value) for value in pose.position)
    sign = -1.0 if w < 0.0 else 1.0
    quat = tuple(rounded(sign * value) for value in (w, x, y, z))
    turned = any(quat[1:])
    return ({"pos": numbers(pos)} if any(pos) else {}) | ({"quat": numbers(quat)} if turned else {})


def inertial(body: Inertial) -> Element:
    """Return ``<inertial>`` of a link, whose frame is that of its body."""
    at = body.pose
    if not is_possible(body):
        return _ball(abs(body.mass) or LIGHT_KG, at)
    mass = {"mass": shortest(body.mass)}
    place = {"pos": numbers(rounded(value) for value in at.position)}
    if not any((body.ixy, body.ixz, body.iyz)):
        turn = {name: value for name, value in placement(at).items() if name == "quat"}
        return element("inertial", place | turn | mass | {"diaginertia": numbers((body.ixx, body.iyy, body.izz))})
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = tensor_in(body, at)
    return element("inertial", place | mass | {"fullinertia": numbers((ixx, iyy, izz, ixy, ixz, iyz))})


def light(kg: float = LIGHT_KG) -> Element:
    """Return ``<inertial>`` of a body of which nothing is stated."""
    return _ball(kg, identity())


def _ball(mass_kg: float, at: Pose) -> Element:
    moment = shortest(mass_kg * 0.4 * 0.01**2)  # of a ball of 1 cm
    place = {"pos": numbers(rounded(value) for value in at.position)}
    return element("inertial", place | {"mass": shortest(mass_kg), "diaginertia": " ".join([moment] * 3)})


def is_possible(body: Inertial) -> bool:
    """Tell whether a body has a mass, and a tensor that some body can have: others are refused as they are loaded."""
    first = body.ixx * body.iyy - body.ixy**2
    minors = (
        body.ixx,
        first,
        body.izz * first - body.ixx * body.iyz**2 + 2.0 * body.ixy * body.iyz * body.ixz - body.iyy * body.ixz**2,
    )
    return body.mass > 0.0 and all(minor > 0.0 for minor in minors)


def tensor_in(body: Inertial, pose: Pose) -> _Tensor:
    """Return the tensor of a body in the axes in which its own axes have this pose."""
    own = ((body.ixx, body.ixy, body.ixz), (body.ixy, body.iyy, body.iyz), (body.ixz, body.iyz, body.izz))
    if pose.quaternion == identity().quaternion:
        return own
    turn = Pose((0.0, 0.0, 0.0), pose.quaternion)
    columns = [turn.apply(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    three = range(3)
    full = [
        [sum(columns[k][i] * own[k][m] * columns[m][j] for k in three for m in three) for j in three] for i in three
    ]
    places = _DIGITS - math.floor(math.log10(max(abs(value) for row in own for value in row)))
    rows = [[round(0.5 * (full[i][j] + full[j][i]), places) for j in three] for i in three]
    return tuple((row[0], row[1], row[2]) for row in rows)


def joint(stated: Joint, limits: DeviceJoint | None, extra: Mapping[str, str]) -> Element:
    """Return ``<joint>`` at the origin of its body; ``extra`` are attributes that follow from who moves it."""
    kind = "slide" if stated.slides else "hinge"
    attributes = {"name": stated.name, "type": kind, "axis": numbers(rounded(value) for value in stated.axis)}
    if limits is not None and limits.type != "continuous" and limits.lower is not None and limits.upper is not None:
        attributes["range"] = numbers((limits.lower, max(limits.upper, limits.lower + _LOCKED)))
    if limits is not None and limits.effort:
        attributes["actuatorfrcrange"] = numbers((-limits.effort, limits.effort))
    dynamics = stated.dynamics
    if dynamics is not None and dynamics.damping > 0.0:
        attributes["damping"] = shortest(dynamics.damping)
    if dynamics is not None and dynamics.friction > 0.0:
        attributes["frictionloss"] = shortest(dynamics.friction)
    return element("joint", attributes | {key: value for key, value in extra.items() if key not in attributes})


def geoms(link: Link, meshes: Meshes, extra: Mapping[str, str]) -> Iterator[Element]:
    """Yield the collision shapes of a link, whose frame is that of its body."""
    color = next((visual.rgba for visual in link.visuals if visual.rgba is not None), None)
    paint = {} if color is None else {"rgba": numbers(color)}
    for shape in link.collisions:
        yield geom(shape.geometry, shape.pose, meshes, {**paint, **extra})


def geom(shape: Geometry, pose: Pose, meshes: Meshes, extra: Mapping[str, str]) -> Element:
    """Return ``<geom>``, or a comment in the place of one that cannot be had."""
    if isinstance(shape, Mesh):
        if shape.filename in meshes.missing:
            return comment(f"left out: the mesh {shape.filename}, which {meshes.missing[shape.filename]}")
        return element("geom", {"type": "mesh", "mesh": meshes.names[shape], **placement(pose), **extra})
    kind, size = _primitive(shape)
    if min(size) <= 0.0:
        return comment(f"left out: a {kind} without extent")
    return element("geom", {"type": kind, "size": numbers(size), **placement(pose), **extra})


def _primitive(shape: Box | Cylinder | Sphere) -> tuple[str, tuple[float, ...]]:
    if isinstance(shape, Box):
        return "box", tuple(length / 2.0 for length in shape.size)
    if isinstance(shape, Cylinder):
        return "cylinder", (shape.radius, shape.length / 2.0)
    return "sphere", (shape.radius,)


def site(name: str, pose: Pose) -> Element:
    """Return ``<site>``: a frame."""
    return element("site", {"name": name, **placement(pose)})
