"""Forward kinematics of a description by hand: Rodrigues' formula and quaternions, nothing of the compiler's own."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from cellc.robot.description.model import Description, Joint

Matrix = npt.NDArray[np.float64]


def axis_rotation(axis: tuple[float, float, float], angle: float) -> Matrix:
    """Return the rotation about a unit axis as a 4 x 4 transform, by Rodrigues' formula."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], dtype=float)
    result = np.eye(4)
    result[:3, :3] = np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k
    return result


def transform(description: Description, root: str, tip: str, positions: dict[str, float]) -> Matrix:
    """Return tip to root; joints that are not named stand at zero, rad or m."""
    by_child = {joint.child: joint for joint in description.joints}
    result = np.eye(4)
    while tip != root:
        joint = by_child[tip]
        result = _joint_transform(joint, positions.get(joint.name, 0.0)) @ result
        tip = joint.parent
    return result


def _joint_transform(joint: Joint, position: float) -> Matrix:
    x, y, z, w = joint.pose.quaternion
    fixed = np.eye(4)
    fixed[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    fixed[:3, 3] = joint.pose.position
    if joint.type == "prismatic":
        slide = np.eye(4)
        slide[:3, 3] = np.array(joint.axis) * position
        return fixed @ slide
    return fixed @ axis_rotation(joint.axis, position)
