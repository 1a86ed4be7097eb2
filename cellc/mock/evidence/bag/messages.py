"""The messages of a bag, field by field in the order of their definitions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import Distro, Feature, features
from cellc.mock.control import GripperGoal, Trajectory
from cellc.mock.evidence.bag.cdr import CdrWriter, MessageRows

JOINT_STATE = "sensor_msgs/msg/JointState"
TF_MESSAGE = "tf2_msgs/msg/TFMessage"
JOINT_TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
DIAGNOSTIC_ARRAY = "diagnostic_msgs/msg/DiagnosticArray"
POSE_STAMPED = "geometry_msgs/msg/PoseStamped"
STRING = "std_msgs/msg/String"
GOAL_STATUS = "action_msgs/msg/GoalStatusArray"
LOG = "rcl_interfaces/msg/Log"
CLOCK = "rosgraph_msgs/msg/Clock"
IMAGE = "sensor_msgs/msg/Image"
CAMERA_INFO = "sensor_msgs/msg/CameraInfo"

CONTROLLER_STATE = "control_msgs/msg/JointTrajectoryControllerState"
POINT_FIELDS = ("positions", "velocities", "accelerations", "effort")
"""Sequences of a trajectory_msgs/JointTrajectoryPoint."""
_MULTI_DOF_SEQUENCES = 3
"""Sequences of a MultiDOFJointTrajectoryPoint: transforms, velocities, accelerations; no controller here has any."""


@dataclass(frozen=True, slots=True)
class StampedTransform:
    """A geometry_msgs/TransformStamped: the pose of ``child`` in ``parent``."""

    stamp_ns: int
    parent: str
    child: str
    pose: Pose


@dataclass(frozen=True, slots=True)
class DiagnosticStatus:
    """A diagnostic_msgs/DiagnosticStatus; levels are 0 OK, 1 WARN, 2 ERROR, 3 STALE."""

    level: int
    name: str
    message: str
    values: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class GoalState:
    """An action_msgs/GoalStatus: the 16 bytes of the id, when the goal was accepted, and a state of that message."""

    goal_id: bytes
    accepted_ns: int
    status: int


def goal_status(states: Sequence[GoalState]) -> bytes:
    """Encode an action_msgs/GoalStatusArray."""
    writer = CdrWriter()
    writer.uint32(len(states))
    for state in states:
        for byte in state.goal_id:
            writer.octet(byte)
        writer.time(state.accepted_ns)
        writer.octet(state.status)
    return writer.message()


def log(stamp_ns: int, level: int, node: str, text: str) -> bytes:
    """Encode a rcl_interfaces/Log; file, function and line are left empty."""
    writer = CdrWriter()
    writer.time(stamp_ns)
    writer.octet(level)
    for word in (node, text, "", ""):
        writer.string(word)
    writer.uint32(0)
    return writer.message()


def clock(now_ns: int) -> bytes:
    """Encode a rosgraph_msgs/Clock."""
    writer = CdrWriter()
    writer.time(now_ns)
    return writer.message()


def image(stamp_ns: int, frame: str, encoding: str, pixels: NDArray[np.generic]) -> bytes:
    """Encode a sensor_msgs/Image; pixels are of shape (height, width) or (height, width, channels)."""
    height, width = pixels.shape[:2]
    data = pixels.astype(pixels.dtype.newbyteorder("<")).tobytes()
    writer = CdrWriter()
    _header(writer, stamp_ns, frame)
    writer.uint32(height)
    writer.uint32(width)
    writer.string(encoding)
    writer.octet(0)  # little endian
    writer.uint32(len(data) // height)
    writer.octets(data)
    return writer.message()


def camera_info(stamp_ns: int, frame: str, size: tuple[int, int], focal: float, center: tuple[float, float]) -> bytes:
    """Encode a sensor_msgs/CameraInfo of a camera with square pixels and without distortion.

    Args:
        size: width and height.
        focal: in pixels.
        center: the pixel on the optical axis.
    """
    (width, height), (u, v) = size, center
    writer = CdrWriter()
    _header(writer, stamp_ns, frame)
    writer.uint32(height)
    writer.uint32(width)
    writer.string("plumb_bob")
    writer.float64s((0.0,) * 5)
    writer.fixed_float64s((focal, 0.0, u, 0.0, focal, v, 0.0, 0.0, 1.0))
    writer.fixed_float64s((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0))
    writer.fixed_float64s((focal, 0.0, u, 0.0, 0.0, focal, v, 0.0, 0.0, 0.0, 1.0, 0.0))
    for _ in range(6):  # binning, and a region of interest that is the whole image
        writer.uint32(0)
    writer.octet(0)
    return writer.message()


def string(text: str) -> bytes:
    """Encode a std_msgs/String."""
    writer = CdrWriter()
    writer.string(text)
    return writer.message()


def transforms(stamped: Sequence[StampedTransform]) -> bytes:
    """Encode a tf2_msgs/TFMessage."""
    writer = CdrWriter()
    writer.uint32(len(stamped))
    for each in stamped:
        _header(writer, each.stamp_ns, each.parent)
        writer.string(each.child)
        writer.fixed_float64s((*each.pose.position, *each.pose.quaternion))
    return writer.message()


def pose_stamped(stamp_ns: int, frame: str, pose: Pose) -> bytes:
    """Encode a geometry_msgs/PoseStamped."""
    writer = CdrWriter()
    _header(writer, stamp_ns, frame)
    writer.fixed_float64s((*pose.position, *pose.quaternion))
    return writer.message()


def joint_trajectory(trajectory: Trajectory) -> bytes:
    """Encode a trajectory_msgs/JointTrajectory."""
    writer = CdrWriter()
    _header(writer, trajectory.stamp_ns, "")
    writer.strings(trajectory.joint_names)
    writer.uint32(len(trajectory.points))
    for point in trajectory.points:
        for values in (point.positions, point.velocities, point.accelerations, point.effort):
            writer.float64s(values)
        writer.time(point.time_from_start_ns)
    return writer.message()


def gripper_command(stamp_ns: int, joints: Sequence[str], goal: GripperGoal) -> bytes:
    """Encode the sensor_msgs/JointState that is the goal of a ParallelGripperCommand."""
    writer = CdrWriter()
    _header(writer, stamp_ns, "")
    writer.strings(joints)
    for values in (goal.position, goal.velocity, goal.effort):
        writer.float64s(values)
    return writer.message()


def diagnostics(stamp_ns: int, statuses: Sequence[DiagnosticStatus]) -> bytes:
    """Encode a diagnostic_msgs/DiagnosticArray."""
    writer = CdrWriter()
    _header(writer, stamp_ns, "")
    writer.uint32(len(statuses))
    for status in statuses:
        writer.octet(status.level)
        for text in (status.name, status.message, ""):  # the last is hardware_id
            writer.string(text)
        writer.uint32(len(status.values))
        for key, value in status.values:
            writer.string(key)
            writer.string(value)
    return writer.message()


def _header(writer: CdrWriter, stamp_ns: int, frame: str) -> None:
    writer.time(stamp_ns)
    writer.string(frame)


Array = NDArray[np.float64]
Point = Mapping[str, Array]
"""Filled fields of a point, each of shape (messages, joints); the others are empty."""


def joint_state_shape(names: Sequence[str]) -> MessageRows:
    """Return the shape of a sensor_msgs/JointState; its numbers are position, velocity and effort."""
    writer = CdrWriter()
    stamp_at = _empty_header(writer)
    writer.strings(names)
    offsets = tuple(writer.float64s((0.0,) * len(names)) for _ in range(3))
    return MessageRows(writer.message(), stamp_at, offsets)


def controller_state_rows(
    joints: Sequence[str], points: Sequence[Point], scaling: Array, distro: Distro
) -> tuple[MessageRows, list[Array]]:
    """Return the shape of a control_msgs/JointTrajectoryControllerState, and the numbers of its rows.

    Older distributions repeat reference and feedback as desired and actual; later ones have the speed scaling factor.

    Args:
        points: reference, feedback, error and output.
        scaling: speed scaling factor, shape (messages,).
    """
    has_desired = Feature.SCALED_STATE not in features(distro)
    points = (*points, *points[:2]) if has_desired else tuple(points)
    writer = CdrWriter()
    stamp_at = _empty_header(writer)
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


def _empty_header(writer: CdrWriter) -> int:
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
