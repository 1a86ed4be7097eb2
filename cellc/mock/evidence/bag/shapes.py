"""Shapes of the messages that come with every update cycle: joint states and the state of a trajectory controller."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from cellc.mock.evidence.bag.cdr import CdrWriter
from cellc.mock.evidence.bag.rows import MessageRows

CONTROLLER_STATE = "control_msgs/msg/JointTrajectoryControllerState"
POINT_FIELDS = ("positions", "velocities", "accelerations", "effort")
"""Sequences of a trajectory_msgs/JointTrajectoryPoint."""
_MULTI_DOF_SEQUENCES = 3
"""Sequences of a MultiDOFJointTrajectoryPoint: transforms, velocities, accelerations; no controller here has any."""

Array = NDArray[np.float64]
Point = Mapping[str, Array]
"""Filled fields of a point, each of shape (messages, joints); the others are empty."""


def joint_state_shape(names: Sequence[str]) -> MessageRows:
    """Return the shape of a sensor_msgs/JointState; its numbers are position, velocity and effort."""
    writer = CdrWriter()
    stamp_at = _header(writer)
    writer.strings(names)
    offsets = tuple(writer.float64s((0.0,) * len(names)) for _ in range(3))
    return MessageRows(writer.message(), stamp_at, offsets)


def controller_state_rows(
    joints: Sequence[str], points: Sequence[Point], scaling: Array, distro: str
) -> tuple[MessageRows, list[Array]]:
    """Return the shape of a control_msgs/JointTrajectoryControllerState, and the numbers of its rows.

    Humble repeats reference and feedback as desired and actual; later ones have the speed scaling factor instead.

    Args:
        points: reference, feedback, error and output.
        scaling: speed scaling factor, shape (messages,).
    """
    has_desired = distro == "humble"
    points = (*points, *points[:2]) if has_desired else tuple(points)
    writer = CdrWriter()
    stamp_at = _header(writer)
    writer.strings(joints)
    offsets = [offset for point in points for offset in _point(writer, point, len(joints))]
    numbers = [point[field] for point in points for field in POINT_FIELDS if field in point]
    writer.strings(())
    for _ in points:
        for _ in range(_MULTI_DOF_SEQUENCES):
            writer.uint32(0)
        writer.time(0)
    if not has_desired:
        offsets.append(writer.float64(0.0))
        numbers.append(scaling[:, None])
    return MessageRows(writer.message(), stamp_at, tuple(offsets)), numbers


def _header(writer: CdrWriter) -> int:
    stamp_at = writer.time(0)
    writer.string("")
    return stamp_at


def _point(writer: CdrWriter, point: Point, joints: int) -> list[int]:
    offsets: list[int] = []
    for field in POINT_FIELDS:
        offset = writer.float64s((0.0,) * joints if field in point else ())
        offsets += [offset] if field in point else []
    writer.time(0)
    return offsets
