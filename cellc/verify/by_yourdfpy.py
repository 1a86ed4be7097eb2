"""Read a robot description with yourdfpy."""

from __future__ import annotations

import math
from io import BytesIO
from typing import Any

from cellc.transforms import Pose
from cellc.verify.held_interrupt import held_interrupt
from cellc.verify.lean_import import import_yourdfpy
from cellc.verify.reading import JointReading, Reading, RefusedError, displaced_positions

_MOVABLE = ("revolute", "prismatic", "continuous")


def read_by_yourdfpy(urdf: str) -> tuple[Reading, dict[str, float]]:
    """Return joints and link poses, and the positions of all joints in the displaced poses, mimic joints included.

    Raises:
        RefusedError: yourdfpy does not take the description.
    """
    try:
        with held_interrupt():
            # Transforms alone: no mesh is opened, and nothing is looked up beside the text.
            robot = import_yourdfpy().URDF.load(BytesIO(urdf.encode()), load_meshes=False)
    except Exception as error:  # it lets through whatever its parts raise
        raise RefusedError(f"yourdfpy refuses it: {type(error).__name__} {error}") from error
    movable = [joint for joint in robot.robot.joints if joint.type in _MOVABLE]
    mimicked = {joint.name: joint.mimic.joint if joint.mimic else None for joint in movable}
    positions = displaced_positions(mimicked)
    at_zero = _poses(robot, dict.fromkeys(positions, 0.0))
    displaced = _poses(robot, positions)
    positions |= {joint.name: _followed(joint, positions) for joint in movable if joint.mimic}
    return Reading({joint.name: _joint(joint) for joint in movable}, at_zero, displaced), positions


def _followed(joint: Any, positions: dict[str, float]) -> float:
    multiplier = 1.0 if joint.mimic.multiplier is None else joint.mimic.multiplier
    return float(multiplier * positions.get(joint.mimic.joint, 0.0) + (joint.mimic.offset or 0.0))


def _joint(joint: Any) -> JointReading:
    limit = joint.limit
    is_bounded = joint.type != "continuous"
    lower = (limit.lower or 0.0) if limit and is_bounded else -math.inf
    upper = (limit.upper or 0.0) if limit and is_bounded else math.inf
    velocity, effort = (limit.velocity, limit.effort) if limit else (None, None)
    return JointReading(
        lower, upper, math.inf if velocity is None else velocity, math.inf if effort is None else effort
    )


def _poses(robot: Any, positions: dict[str, float]) -> dict[str, Pose]:
    robot.update_cfg([positions[name] for name in robot.actuated_joint_names])
    return {name: _pose(robot.get_transform(name)) for name in robot.link_map}


def _pose(matrix: Any) -> Pose:
    """Read a homogeneous transform; the quaternion by the largest of its four components (Shepperd 1978)."""
    m = [[float(value) for value in row] for row in matrix]
    squares = (
        1.0 + m[0][0] - m[1][1] - m[2][2],
        1.0 - m[0][0] + m[1][1] - m[2][2],
        1.0 - m[0][0] - m[1][1] + m[2][2],
        1.0 + m[0][0] + m[1][1] + m[2][2],
    )
    largest = squares.index(max(squares))
    double = math.sqrt(squares[largest]) * 2.0
    sums = {(0, 1): m[0][1] + m[1][0], (0, 2): m[0][2] + m[2][0], (1, 2): m[1][2] + m[2][1]}
    differences = {(0, 3): m[2][1] - m[1][2], (1, 3): m[0][2] - m[2][0], (2, 3): m[1][0] - m[0][1]}
    products = sums | differences
    x, y, z, w = (
        double / 4.0 if i == largest else products[(min(i, largest), max(i, largest))] / double for i in range(4)
    )
    return Pose((m[0][3], m[1][3], m[2][3]), (x, y, z, w))
