"""URDF text into a Description, every link and joint with its place in the file.

Reads what the URDF specification calls the model, and the components of ``<ros2_control>``. Elements of other consumers
(``<transmission>``, ``<gazebo>``) are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import TypeVar

from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span, did_you_mean
from cellc.contract.diagnostics.unsafe_text import hidden, substitution
from cellc.contract.limits import limits
from cellc.robot.description.model import (
    Box,
    Collision,
    Cylinder,
    Description,
    Geometry,
    Inertial,
    Joint,
    JointDynamics,
    JointLimit,
    Link,
    Mesh,
    Mimic,
    SafetyController,
    Sphere,
    Visual,
)
from cellc.robot.description.ros2_control import read_hardware
from cellc.robot.description.urdf_values import (
    UrdfError,
    length,
    number,
    number_or,
    numbers,
    optional_number,
    origin_pose,
    refused,
    required,
    required_child,
    vector,
)
from cellc.robot.description.xml_tree import XmlElement, read_xml

_READ = ("link", "joint", "material", "ros2_control")
JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
Origins = Mapping[tuple[str, str], Span]
"""Where a ``("link", name)`` or ``("joint", name)`` was written, for text that was expanded from xacro."""

Rgba = tuple[float, float, float, float]

_T = TypeVar("_T")


def read_urdf(text: str, file: str, origins: Origins | None = None, *, from_user: bool = False) -> Outcome[Description]:
    """Read a URDF document; what is malformed is reported, what is merely wrong is left for the rules.

    Args:
        text: the document.
        file: the path as the user named it, for spans.
        origins: places of links and joints before expansion; where given they replace those in ``text``.
        from_user: refuse texts too that other programs would evaluate; what cellc generates asks xacro for
            share folders.

    Returns:
        The description, or None and a diagnostic for each link or joint that cannot be read.
    """
    parsed = read_xml(text, file)
    if parsed.value is None:
        return Outcome(None, parsed.diagnostics)
    root = parsed.value
    if root.tag != "robot":
        message = f"the root element is `<{root.tag}>`, a URDF begins with `<robot>`"
        return Outcome(None, (Diagnostic("urdf-not-a-robot", Severity.ERROR, message, root.span),))
    if too_many := _too_many(root, of_device=from_user):
        return Outcome(None, (too_many,))
    _move_spans(root, origins or {})
    problems: list[Diagnostic] = []
    name = _read_each([root], lambda element: required(element, "name"), problems)
    colors = _read_each(root.all("material"), _read_color, problems)
    known = {material: rgba for material, rgba in colors if rgba is not None}
    links: list[Link] = _read_each(root.all("link"), lambda element: _read_link(element, known), problems)
    joints = _read_each(root.all("joint"), _read_joint, problems)
    problems.extend(_left_from_xacro(root))
    problems.extend(_unsafe(root, from_user))
    if problems:
        return Outcome(None, tuple(problems))
    return Outcome(Description(name[0], tuple(links), tuple(joints), *read_hardware(root)))


def _too_many(root: XmlElement, *, of_device: bool) -> Diagnostic | None:
    """Refuse more links than the limits allow, or more joints that move: what is made of a device has their square."""
    most = limits()
    moving = [joint for joint in root.all("joint") if joint.attributes.get("type") != "fixed"]
    for count, allowed, what in (
        (len(root.all("link")), most.robot_links if of_device else most.cell_links, "links"),
        (len(moving), most.robot_joints if of_device else most.cell_joints, "joints that move"),
    ):
        if count > allowed:
            message = f"the description has {count} {what}, at most {allowed} are read"
            return Diagnostic("xml-too-large", Severity.ERROR, message, root.span, help="split it into several devices")
    return None


def _read_each(elements: Iterable[XmlElement], read: Callable[[XmlElement], _T], found: list[Diagnostic]) -> list[_T]:
    """Read every element that can be read, and find something at each of the others."""
    values = (_read_or_find(element, read, found) for element in elements)
    return [value for value in values if value is not None]


def _read_or_find(element: XmlElement, read: Callable[[XmlElement], _T], found: list[Diagnostic]) -> _T | None:
    try:
        return read(element)
    except UrdfError as refusal:
        found.append(refusal.diagnostic)
        return None


def _move_spans(root: XmlElement, origins: Origins) -> None:
    for element in root.children:
        span = origins.get((element.tag, element.attributes.get("name", "")))
        if span is not None:
            _set_span(element, span)


def _set_span(element: XmlElement, span: Span) -> None:
    element.span = span
    for child in element.children:
        _set_span(child, span)


def _left_from_xacro(root: XmlElement) -> Iterable[Diagnostic]:
    for element in root.children:
        if element.tag.startswith("xacro:"):
            message = f"`<{element.tag}>` is xacro, not URDF"
            help_text = "name the file `….xacro` so that it is expanded first"
            yield Diagnostic("urdf-not-expanded", Severity.ERROR, message, element.span, help=help_text)
            return


def _unsafe(root: XmlElement, from_user: bool) -> Iterable[Diagnostic]:
    """Yield texts that hide something in what is read, and of users those that programs would evaluate."""
    read = (element for element in root.children if element.tag in _READ)
    elements = [root, *(inner for element in read for inner in _walked(element))]
    for element in elements:
        for text in (*element.attributes.values(), element.text):
            if from_user and (message := substitution(text)):
                help_text = "name the file `….xacro` so that it is expanded first, or write the value itself"
                yield Diagnostic("urdf-not-expanded", Severity.ERROR, message, element.span, help=help_text)
            if message := hidden(text):
                help_text = "delete the character"
                yield Diagnostic("control-character", Severity.ERROR, message, element.span, help=help_text)
        for attribute, value in element.attributes.items() if from_user else ():
            # A parser makes spaces of those that stand there as they are; these were written as `&#10;`.
            if "\n" in value or "\t" in value:
                message = f"`{attribute}` of `<{element.tag}>` holds a line break or a tab"
                yield Diagnostic("control-character", Severity.ERROR, message, element.span, help="write a space")


def _walked(element: XmlElement) -> Iterable[XmlElement]:
    yield element
    for child in element.children:
        yield from _walked(child)


def _read_color(element: XmlElement) -> tuple[str, Rgba | None]:
    color = element.first("color")
    name = required(element, "name")
    if color is None:
        return (name, None)
    r, g, b, a = numbers(color, "rgba", 4)
    return (name, (r, g, b, a))


def _read_joint(element: XmlElement) -> Joint:
    name, kind = required(element, "name"), required(element, "type")
    if kind not in JOINT_TYPES:
        help_text = did_you_mean(kind, JOINT_TYPES, "joint types")
        raise refused("urdf-unknown-joint-type", element, f"joint `{name}` has the unknown type `{kind}`", help_text)
    axis, limit = element.first("axis"), _optional(element, "limit", _read_limit)
    return Joint(
        name=name,
        type=kind,
        parent=required(required_child(element, "parent"), "link"),
        child=required(required_child(element, "child"), "link"),
        pose=origin_pose(element),
        axis=(1.0, 0.0, 0.0) if axis is None else vector(axis, "xyz"),
        limit=_without_ends(limit) if kind == "continuous" else limit,
        unheld=_ends(limit) if kind == "continuous" else None,
        mimic=_optional(element, "mimic", _read_mimic),
        dynamics=_optional(element, "dynamics", _read_dynamics),
        safety=_optional(element, "safety_controller", _read_safety),
        span=element.span,
    )


def _optional(element: XmlElement, tag: str, read: Callable[[XmlElement], _T]) -> _T | None:
    child = element.first(tag)
    return None if child is None else read(child)


def _ends(limit: JointLimit | None) -> tuple[float, float] | None:
    """Return both ends where they are stated."""
    return None if limit is None or limit.lower is None or limit.upper is None else (limit.lower, limit.upper)


def _without_ends(limit: JointLimit | None) -> JointLimit | None:
    """Leave out what a continuous joint has no meaning for: to every parser its `lower` and `upper` are not there."""
    return None if limit is None else replace(limit, lower=None, upper=None)


def _read_limit(element: XmlElement) -> JointLimit:
    lower, upper, velocity, effort = (
        optional_number(element, attribute) for attribute in ("lower", "upper", "velocity", "effort")
    )
    # Vendors write -1 for one that they do not state; pinocchio refuses a whole description for it.
    stated = None if effort is not None and effort < 0.0 else effort
    return JointLimit(lower, upper, velocity, stated, element.span)


def _read_mimic(element: XmlElement) -> Mimic:
    multiplier, offset = number_or(element, "multiplier", 1.0), number_or(element, "offset", 0.0)
    return Mimic(required(element, "joint"), multiplier, offset, element.span)


def _read_dynamics(element: XmlElement) -> JointDynamics:
    return JointDynamics(number_or(element, "damping", 0.0), number_or(element, "friction", 0.0))


def _read_safety(element: XmlElement) -> SafetyController:
    return SafetyController(
        soft_lower=number_or(element, "soft_lower_limit", 0.0),
        soft_upper=number_or(element, "soft_upper_limit", 0.0),
        k_position=number_or(element, "k_position", 0.0),
        k_velocity=number(element, "k_velocity"),
    )


def _read_link(element: XmlElement, colors: Mapping[str, Rgba]) -> Link:
    """Read one ``<link>``; ``colours`` are the materials that the robot names at its top level."""
    inertial = element.first("inertial")
    return Link(
        name=required(element, "name"),
        inertial=None if inertial is None else _read_inertial(inertial),
        visuals=tuple(_read_visual(visual, colors) for visual in element.all("visual")),
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
        span=element.span,
    )


def _read_collision(element: XmlElement) -> Collision:
    return Collision(element.attributes.get("name"), origin_pose(element), _read_geometry(element))


def _read_visual(element: XmlElement, colors: Mapping[str, Rgba]) -> Visual:
    material = element.first("material")
    name = None if material is None else material.attributes.get("name")
    rgba = colors.get(name) if name is not None else None
    color = None if material is None else material.first("color")
    if color is not None:
        r, g, b, a = numbers(color, "rgba", 4)
        rgba = (r, g, b, a)
    return Visual(element.attributes.get("name"), origin_pose(element), _read_geometry(element), name, rgba)


def _read_geometry(element: XmlElement) -> Geometry:
    geometry = required_child(element, "geometry")
    if len(geometry.children) != 1:
        message = f"`<geometry>` holds {len(geometry.children)} shapes, expected one"
        raise refused("urdf-bad-geometry", geometry, message)
    shape = geometry.children[0]
    if shape.tag == "box":
        return Box(vector(shape, "size"))
    if shape.tag == "cylinder":
        return Cylinder(length(shape, "radius"), length(shape, "length"))
    if shape.tag == "sphere":
        return Sphere(length(shape, "radius"))
    if shape.tag == "mesh":
        scale = vector(shape, "scale") if "scale" in shape.attributes else (1.0, 1.0, 1.0)
        return Mesh(required(shape, "filename"), scale, shape.span)
    help_text = "use `box`, `cylinder`, `sphere` or `mesh`"
    raise refused("urdf-bad-geometry", shape, f"`<{shape.tag}>` is not a shape of URDF", help_text)
