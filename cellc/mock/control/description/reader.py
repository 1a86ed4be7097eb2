"""The whole robot description: URDF joints and hardware components, with the refusals of the manager."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from xml.etree import ElementTree

from cellc.mock.control.description.component import ComponentInfo, PartInfo, read_component
from cellc.mock.control.description.urdf import UrdfJoint, read_joints
from cellc.mock.control.errors import DescriptionError

_KEPT = 8


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """What ros2_control takes from a robot description."""

    joints: Mapping[str, UrdfJoint]
    components: tuple[ComponentInfo, ...]


def _parse_xml(text: str) -> ElementTree.Element:
    # A DTD could define entities that grow without bound; no URDF needs one.
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise DescriptionError("invalid URDF passed in to robot parser: document type declarations are refused")
    try:
        return ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        line, _ = error.position
        raise DescriptionError(
            "invalid URDF passed in to robot parser: Error=XML_ERROR_PARSING_ELEMENT ErrorID=6 (0x6) "
            f"Line number={line}"
        ) from None


def _is_mimic(joint: UrdfJoint, part: PartInfo) -> bool:
    if part.mimic is not None and part.mimic.strip().lower() == "true" and joint.mimic is None:
        raise DescriptionError(f"Joint '{joint.name}' has no mimic information in the URDF.")
    return joint.mimic is not None and (part.mimic is None or part.mimic.strip().lower() != "false")


def _check_joint(part: PartInfo, component: ComponentInfo, joints: Mapping[str, UrdfJoint]) -> None:
    joint = joints.get(part.name)
    if joint is None:
        raise DescriptionError(f"Joint '{part.name}' not found in URDF")
    if joint.type == "fixed":
        raise DescriptionError(
            f"Joint '{part.name}' is of type 'fixed'. Fixed joints do not make sense in ros2_control."
        )
    if not _is_mimic(joint, part) or joint.mimic is None:
        return
    if part.command_interfaces:
        raise DescriptionError(
            f"Joint '{part.name}' has mimic attribute not set to false: "
            "Activated mimic joints cannot have command interfaces."
        )
    if all(other.name != joint.mimic.joint for other in component.joints):
        raise DescriptionError(f"Mimic joint '{joint.mimic.joint}' not found in <ros2_control> tag")


@lru_cache(maxsize=_KEPT)
def read_description(text: str) -> RobotDescription:
    """Read a URDF with its `<ros2_control>` elements; kept, since every run of a cell starts from the same text.

    Args:
        text: the robot description.

    Returns:
        Joints and components.

    Raises:
        DescriptionError: where the controller manager would refuse it, with its message.
    """
    robot = _parse_xml(text)
    if robot.tag != "robot":
        raise DescriptionError("the robot tag is not root element in URDF")
    elements = robot.findall("ros2_control")
    if not elements:
        raise DescriptionError("no 'ros2_control' tag found in the URDF")
    components = tuple(read_component(element) for element in elements)
    joints = read_joints(robot)
    for component in components:
        for part in component.joints:
            _check_joint(part, component, joints)
    return RobotDescription(joints, components)
