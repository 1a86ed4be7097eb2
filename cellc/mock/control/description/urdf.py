"""Joints of a URDF with the few fields that ros2_control looks at, checked as urdfdom checks them."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree.ElementTree import Element

from cellc.mock.control.errors import DescriptionError

# urdfdom answers every one of these mistakes with this one sentence.
_REFUSED = "Failed to parse URDF file"
_JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


@dataclass(frozen=True, slots=True)
class UrdfLimit:
    """The `<limit>` of a joint; rad or m, rad/s or m/s, N m or N."""

    lower: float
    upper: float
    velocity: float
    effort: float


@dataclass(frozen=True, slots=True)
class UrdfMimic:
    """The `<mimic>` of a joint: value = offset + multiplier * value of `joint`."""

    joint: str
    multiplier: float
    offset: float


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """A joint of the URDF."""

    name: str
    type: str
    limit: UrdfLimit | None
    mimic: UrdfMimic | None


def _number(element: Element, attribute: str, default: float | None) -> float:
    text = element.get(attribute)
    if text is None:
        if default is None:
            raise DescriptionError(_REFUSED)
        return default
    try:
        return float(text)
    except ValueError:
        raise DescriptionError(_REFUSED) from None


def _read_limit(joint: Element, kind: str) -> UrdfLimit | None:
    element = joint.find("limit")
    if element is None:
        if kind in ("revolute", "prismatic"):
            raise DescriptionError(_REFUSED)
        return None
    # urdfdom 3: lower and upper default to 0, velocity and effort have no default.
    return UrdfLimit(
        _number(element, "lower", 0.0),
        _number(element, "upper", 0.0),
        _number(element, "velocity", None),
        _number(element, "effort", None),
    )


def _read_mimic(joint: Element) -> UrdfMimic | None:
    element = joint.find("mimic")
    if element is None:
        return None
    parent = element.get("joint")
    if parent is None:
        raise DescriptionError(_REFUSED)
    return UrdfMimic(parent, _number(element, "multiplier", 1.0), _number(element, "offset", 0.0))


def _read_joint(element: Element) -> UrdfJoint:
    name, kind = element.get("name"), element.get("type")
    if name is None or kind not in _JOINT_TYPES:
        raise DescriptionError(_REFUSED)
    return UrdfJoint(name, kind, _read_limit(element, kind), _read_mimic(element))


def read_joints(robot: Element) -> dict[str, UrdfJoint]:
    """Read the joints of a URDF.

    Args:
        robot: the root element.

    Returns:
        The joints by name, in the order of the file.

    Raises:
        DescriptionError: where urdfdom would refuse the whole file.
    """
    links = [link.get("name") for link in robot.findall("link")]
    if None in links or len(links) != len(set(links)):
        raise DescriptionError(_REFUSED)
    joints: dict[str, UrdfJoint] = {}
    for element in robot.findall("joint"):
        joint = _read_joint(element)
        if joint.name in joints:
            raise DescriptionError(_REFUSED)
        joints[joint.name] = joint
    return joints
