"""Reading of the robot description as ros2_control reads it."""

from cellc.mock.control.description.component import ComponentInfo, InterfaceInfo, PartInfo
from cellc.mock.control.description.limits import JointLimits, joint_limits
from cellc.mock.control.description.reader import RobotDescription, read_description

__all__ = [
    "ComponentInfo",
    "InterfaceInfo",
    "JointLimits",
    "PartInfo",
    "RobotDescription",
    "joint_limits",
    "read_description",
]
