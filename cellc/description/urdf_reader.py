"""URDF text into a Description, every link and joint with its place in the file.

Reads what the URDF specification calls the model. Elements of other consumers (``<ros2_control>``, ``<transmission>``,
``<gazebo>``) are not part of it: the compiler writes its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar

from cellc.description.model import (
    Description,
    Joint,
    JointDynamics,
    JointLimit,
    Link,
    Mimic,
    SafetyController,
)
from cellc.description.urdf_shapes import read_link
from cellc.description.urdf_values import (
    UrdfError,
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
from cellc.description.xml_tree import XmlElement, read_xml
from cellc.diagnostics import Diagnostic, Outcome, Severity, Span, did_you_mean

JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
Origins = Mapping[tuple[str, str], Span]
"""Where a ``("link", name)`` or ``("joint", name)`` was written, for text that was expanded from xacro."""

_T = TypeVar("_T")


def read_urdf(text: str, file: str, origins: Origins | None = None) -> Outcome[Description]:
    """Read a URDF document; what is malformed is reported, what is merely wrong is left for the rules.

    Args:
        text: the document.
        file: the path as the user named it, for spans.
        origins: places of links and joints before expansion; where given they replace those in ``text``.

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
    _move_spans(root, origins or {})
    found: list[Diagnostic] = []
    name = _read_each([root], lambda element: required(element, "name"), found)
    colours = _read_each(root.all("material"), _read_colour, found)
    known = {material: rgba for material, rgba in colours if rgba is not None}
    links: list[Link] = _read_each(root.all("link"), lambda element: read_link(element, known), found)
    joints = _read_each(root.all("joint"), _read_joint, found)
    found.extend(_left_from_xacro(root))
    if found:
        return Outcome(None, tuple(found))
    return Outcome(Description(name[0], tuple(links), tuple(joints)))


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


def _read_colour(element: XmlElement) -> tuple[str, tuple[float, float, float, float] | None]:
    colour = element.first("color")
    name = required(element, "name")
    if colour is None:
        return (name, None)
    r, g, b, a = numbers(colour, "rgba", 4)
    return (name, (r, g, b, a))


def _read_joint(element: XmlElement) -> Joint:
    name, kind = required(element, "name"), required(element, "type")
    if kind not in JOINT_TYPES:
        help_text = did_you_mean(kind, JOINT_TYPES, "joint types")
        raise refused("urdf-unknown-joint-type", element, f"joint `{name}` has the unknown type `{kind}`", help_text)
    axis = element.first("axis")
    return Joint(
        name=name,
        type=kind,
        parent=required(required_child(element, "parent"), "link"),
        child=required(required_child(element, "child"), "link"),
        pose=origin_pose(element),
        axis=(1.0, 0.0, 0.0) if axis is None else vector(axis, "xyz"),
        limit=_optional(element, "limit", _read_limit),
        mimic=_optional(element, "mimic", _read_mimic),
        dynamics=_optional(element, "dynamics", _read_dynamics),
        safety=_optional(element, "safety_controller", _read_safety),
        span=element.span,
    )


def _optional(element: XmlElement, tag: str, read: Callable[[XmlElement], _T]) -> _T | None:
    child = element.first(tag)
    return None if child is None else read(child)


def _read_limit(element: XmlElement) -> JointLimit:
    lower, upper, velocity, effort = (
        optional_number(element, attribute) for attribute in ("lower", "upper", "velocity", "effort")
    )
    return JointLimit(lower, upper, velocity, effort)


def _read_mimic(element: XmlElement) -> Mimic:
    return Mimic(required(element, "joint"), number_or(element, "multiplier", 1.0), number_or(element, "offset", 0.0))


def _read_dynamics(element: XmlElement) -> JointDynamics:
    return JointDynamics(number_or(element, "damping", 0.0), number_or(element, "friction", 0.0))


def _read_safety(element: XmlElement) -> SafetyController:
    return SafetyController(
        soft_lower=number_or(element, "soft_lower_limit", 0.0),
        soft_upper=number_or(element, "soft_upper_limit", 0.0),
        k_position=number_or(element, "k_position", 0.0),
        k_velocity=number(element, "k_velocity"),
    )
