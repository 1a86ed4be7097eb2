"""What ros2_control takes from a robot description, with the refusals of urdfdom and of the controller manager."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from cellc.contract.frozen import dataclass
from cellc.contract.quantities import LARGEST
from cellc.mock.control.errors import DescriptionError
from cellc.robot.description.model import Description, HardwareComponent, HardwarePart, Joint
from cellc.robot.description.urdf_reader import read_urdf

# urdfdom answers every mistake in links and joints with this one sentence.
_REFUSED = "Failed to parse URDF file"
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_NOT_XML = "invalid URDF passed in to robot parser: "


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """Joints by name, and the hardware components."""

    joints: Mapping[str, Joint]
    components: tuple[HardwareComponent, ...]


def take_description(source: str | Description) -> RobotDescription:
    """Return what the controller manager takes from a URDF, or from what was read of it before.

    Raises:
        DescriptionError: where the controller manager would refuse it, with its message.
    """
    description = _read(source) if isinstance(source, str) else source
    if description.hardware_error:
        raise DescriptionError(description.hardware_error)
    if not description.hardware:
        raise DescriptionError("no 'ros2_control' tag found in the URDF")
    _check_as_urdfdom(description)
    joints = {joint.name: joint for joint in description.joints}
    for component in description.hardware:
        for part in component.joints:
            _check_part(part, component, joints)
    return RobotDescription(joints, description.hardware)


def _read(text: str) -> Description:
    read = read_urdf(text, "robot_description")
    if read.value is None:
        raise DescriptionError(_refusal(read.diagnostics[0].code, read.diagnostics[0].span.line))
    return read.value


def _refusal(code: str, line: int) -> str:
    """Return the message of the real parser for a text that our reader refuses."""
    if code == "xml-entities":  # entities could grow without bound, and no URDF needs one
        return f"{_NOT_XML}document type declarations are refused"
    if code == "xml-not-well-formed":
        return f"{_NOT_XML}Error=XML_ERROR_PARSING_ELEMENT ErrorID=6 (0x6) Line number={line}"
    if code == "urdf-not-a-robot":
        return "the robot tag is not root element in URDF"
    return _REFUSED


def _check_as_urdfdom(description: Description) -> None:
    """Refuse repeated names, and joints without the limits that they need."""
    for names in ([link.name for link in description.links], [joint.name for joint in description.joints]):
        if len(names) != len(set(names)):
            raise DescriptionError(_REFUSED)
    for joint in description.joints:
        needed = joint.limit is not None or joint.type in ("revolute", "prismatic")
        if needed and (joint.limit is None or joint.limit.velocity is None or joint.limit.effort is None):
            raise DescriptionError(_REFUSED)


def _check_part(part: HardwarePart, component: HardwareComponent, joints: Mapping[str, Joint]) -> None:
    joint = joints.get(part.name)
    if joint is None:
        raise DescriptionError(f"Joint '{part.name}' not found in URDF")
    if joint.type == "fixed":
        raise DescriptionError(
            f"Joint '{part.name}' is of type 'fixed'. Fixed joints do not make sense in ros2_control."
        )
    if part.mimic is not None and part.mimic.strip().lower() == "true" and joint.mimic is None:
        raise DescriptionError(f"Joint '{joint.name}' has no mimic information in the URDF.")
    if joint.mimic is None or not follows(part):
        return
    if part.command_interfaces:
        raise DescriptionError(
            f"Joint '{part.name}' has mimic attribute not set to false: "
            "Activated mimic joints cannot have command interfaces."
        )
    if all(other.name != joint.mimic.joint for other in component.joints):
        raise DescriptionError(f"Mimic joint '{joint.mimic.joint}' not found in <ros2_control> tag")


def follows(part: HardwarePart) -> bool:
    """Tell whether hardware lets a joint follow the joint that the URDF says; it does by default."""
    return part.mimic is None or part.mimic.strip().lower() != "false"


def read_flag(text: str) -> bool:
    """Read a boolean as hardware_interface does: only true and false, in any case, with white space around.

    Raises:
        ValueError: for everything else.
    """
    word = text.strip().lower()
    if word not in ("true", "false"):
        raise ValueError(f"Input string : '{text}' is not a valid boolean value. Expected 'true' or 'false'.")
    return word == "true"


def read_number(text: str) -> float:
    """Read a number as hardware_interface does: a decimal that a double can hold, nothing else in the text.

    Raises:
        ValueError: for everything else, and for what is beyond every machine: sums and squares of it would be infinite.
    """
    if _NUMBER.fullmatch(text) is None or not math.isfinite(float(text)):
        raise ValueError("Failed converting string to real number")
    if abs(float(text)) > LARGEST:
        raise ValueError(f"`{text}` must be from {-LARGEST:g} to {LARGEST:g}")
    return float(text)


@dataclass(frozen=True, slots=True)
class JointLimits:
    """Limits that the joint limiters enforce; infinite without one.

    Attributes:
        lower: rad or m.
        upper: rad or m.
        velocity: rad/s or m/s, symmetric.
        effort: N m or N, symmetric.
        acceleration: rad/s² or m/s².
        deceleration: rad/s² or m/s².
    """

    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    effort: float = math.inf
    acceleration: float = math.inf
    deceleration: float = math.inf

    @property
    def has_position(self) -> bool:
        """Whether the position is limited."""
        return math.isfinite(self.lower) or math.isfinite(self.upper)


def joint_limits(joint: Joint, part: HardwarePart) -> JointLimits:
    """Combine the limits of the URDF with those of the command interfaces, the narrower one winning.

    Args:
        joint: the joint of the URDF.
        part: the joint inside ``<ros2_control>``.

    Returns:
        The limits; none at all with ``<limits enable="false"/>`` in the joint.
    """
    if not part.limits_enabled:
        return JointLimits()
    lower, upper, velocity, effort = _urdf_limits(joint)
    acceleration = deceleration = math.inf
    for interface in part.command_interfaces:
        minimum, maximum = _bound(interface.minimum, -math.inf), _bound(interface.maximum, math.inf)
        symmetric = min(abs(minimum), abs(maximum))
        if interface.name == "position":
            lower, upper = max(lower, minimum), min(upper, maximum)
        elif interface.name == "velocity":
            velocity = min(velocity, symmetric)
        elif interface.name == "effort":
            effort = min(effort, symmetric)
        elif interface.name == "acceleration":
            acceleration, deceleration = abs(maximum), abs(minimum)
    return JointLimits(lower, upper, velocity, effort, acceleration, deceleration)


def _urdf_limits(joint: Joint) -> tuple[float, float, float, float]:
    limit = joint.limit
    if limit is None or limit.velocity is None or limit.effort is None:
        return -math.inf, math.inf, math.inf, math.inf
    if joint.type not in ("revolute", "prismatic"):
        return -math.inf, math.inf, limit.velocity, limit.effort
    # urdfdom 3: lower and upper are 0 where they are not stated.
    return limit.lower or 0.0, limit.upper or 0.0, limit.velocity, limit.effort


def _bound(text: str, default: float) -> float:
    """Return a `min` or `max`, or the default for text that is not a number, which ros2_control skips too."""
    try:
        return read_number(text)
    except ValueError:
        return default
