"""Links and joints of devices, frames and scene boxes as URDF elements."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from xml.etree.ElementTree import Element

from cellc.compiler.cell.device import Device, DeviceJoint
from cellc.compiler.cell.frame import Solid
from cellc.compiler.formats.numbers import rounded, shortest
from cellc.compiler.formats.xml_text import element
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.robot.description.model import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    Joint,
    JointDynamics,
    Link,
    Mesh,
    Mimic,
    SafetyController,
    Sphere,
    Visual,
)

_Color = tuple[float, float, float, float]
_SCENE_COLORS = {"fixture": (0.7, 0.7, 0.7, 1.0), "obstacle": (0.8, 0.5, 0.4, 1.0)}


def numbers(values: Iterable[float]) -> str:
    """Return numbers as an attribute holds them."""
    return " ".join(shortest(value) for value in values)


def origin(pose: Pose) -> tuple[Element, ...]:
    """Return ``<origin>`` in meters and fixed-axis roll, pitch, yaw, or nothing for the identity."""
    xyz = tuple(rounded(value) for value in pose.position)
    rpy = tuple(rounded(value) for value in pose.rpy())
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
    """Return ``<inertial>``: kg and kg m^2 about the center of mass."""
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


@dataclass(frozen=True, slots=True)
class Palette:
    """Name in the robot of each material and color of one device."""

    names: Mapping[tuple[str, _Color], str]

    def definitions(self) -> Iterator[Element]:
        """Yield each material with its color."""
        for (_, color), name in self.names.items():
            yield element("material", {"name": name}, [element("color", {"rgba": numbers(color)})])

    def use(self, visual: Visual) -> tuple[Element, ...]:
        """Return the reference of a shape to its material, or nothing for a shape without color."""
        if visual.rgba is None:
            return ()
        return (element("material", {"name": self.names[_key(visual, visual.rgba)]}),)


def palette_of(device: Device) -> Palette:
    """Collect the materials of a device, in the order of first use."""
    names: dict[tuple[str, _Color], str] = {}
    for visual in (visual for link in device.body.description.links for visual in link.visuals):
        if visual.rgba is not None:
            names.setdefault(_key(visual, visual.rgba), "")
    prefix = device.body.prefix or f"{device.name}_"
    taken: dict[str, int] = {}
    for material, color in names:
        taken[material] = taken.get(material, 0) + 1
        again = "" if taken[material] == 1 else f"_{taken[material]}"
        names[material, color] = f"{prefix}{material}{again}"
    return Palette(names)


def _key(visual: Visual, color: _Color) -> tuple[str, _Color]:
    return (visual.material or "color", color)


def frame_link(name: str) -> Element:
    """Return a link without a body: a frame alone."""
    return element("link", {"name": name})


def device_link(link: Link, palette: Palette) -> Element:
    """Return ``<link>`` with inertia and shapes."""
    body = [] if link.inertial is None else [inertial(link.inertial)]
    shapes = [*(visual(shape, palette.use(shape)) for shape in link.visuals), *map(collision, link.collisions)]
    return element("link", {"name": link.name}, [*body, *shapes])


def scene_link(box: Solid) -> Element:
    """Return the link of a solid thing; it has no inertia, because it does not move."""
    seen = Visual(name=None, pose=box.center, geometry=box.geometry, material=None, rgba=None)
    solid = Collision(name=None, pose=box.center, geometry=box.geometry)
    return element(
        "link",
        {"name": box.name},
        [visual(seen, [element("material", {"name": _material(box.kind)})]), collision(solid)],
    )


def scene_materials(boxes: Iterable[Solid]) -> Iterator[Element]:
    """Yield the material of each kind of box that the scene has."""
    for kind in dict.fromkeys(box.kind for box in boxes):
        color = element("color", {"rgba": numbers(_SCENE_COLORS[kind])})
        yield element("material", {"name": _material(kind)}, [color])


def _material(kind: str) -> str:
    return f"scene_{kind}"


def fixed_joint(name: str, parent: str, child: str, transform_child_to_parent: Pose) -> Element:
    """Return the joint that holds a mount, a frame or a box where it is."""
    return element(
        "joint",
        {"name": name, "type": "fixed"},
        [
            *origin(transform_child_to_parent),
            element("parent", {"link": parent}),
            element("child", {"link": child}),
        ],
    )


def device_joint(joint: Joint, limits: DeviceJoint | None) -> Element:
    """Return ``<joint>``; ``limits`` are those of the cell, None for a joint that does not move."""
    children = [
        *origin(joint.pose),
        element("parent", {"link": joint.parent}),
        element("child", {"link": joint.child}),
    ]
    if joint.type != "fixed":
        children.append(element("axis", {"xyz": numbers(rounded(value) for value in joint.axis)}))
    if limits is not None and not (joint.type == "continuous" and limits.velocity is None and limits.effort is None):
        children.append(_limit(limits))
    if joint.mimic is not None:
        children.append(_mimic(joint.mimic))
    if joint.dynamics is not None:
        children.append(_dynamics(joint.dynamics))
    if joint.safety is not None:
        children.append(_safety(joint.safety))
    return element("joint", {"name": joint.name, "type": joint.type}, children)


def _limit(joint: DeviceJoint) -> Element:
    # urdfdom refuses a limit that lacks effort or velocity; a continuous joint has no lower and upper. A joint without
    # one of them is excused and has no commander: its limit is written as 0.
    values = {"lower": joint.lower, "upper": joint.upper} if joint.type != "continuous" else {}
    values |= {"velocity": joint.velocity or 0.0, "effort": joint.effort or 0.0}
    return element("limit", {name: shortest(value) for name, value in values.items() if value is not None})


def _mimic(mimic: Mimic) -> Element:
    factors = {"multiplier": mimic.multiplier, "offset": mimic.offset}
    return element("mimic", {"joint": mimic.joint} | {name: shortest(value) for name, value in factors.items()})


def _dynamics(dynamics: JointDynamics) -> Element:
    return element("dynamics", {"damping": shortest(dynamics.damping), "friction": shortest(dynamics.friction)})


def _safety(safety: SafetyController) -> Element:
    return element(
        "safety_controller",
        {
            "soft_lower_limit": shortest(safety.soft_lower),
            "soft_upper_limit": shortest(safety.soft_upper),
            "k_position": shortest(safety.k_position),
            "k_velocity": shortest(safety.k_velocity),
        },
    )
