"""The messages of a bag, field by field in the order of their definitions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cellc.mock.control import GripperGoal, Trajectory
from cellc.mock.evidence.bag.cdr import CdrWriter
from cellc.transforms import Pose

JOINT_STATE = "sensor_msgs/msg/JointState"
TF_MESSAGE = "tf2_msgs/msg/TFMessage"
JOINT_TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
DIAGNOSTIC_ARRAY = "diagnostic_msgs/msg/DiagnosticArray"
POSE_STAMPED = "geometry_msgs/msg/PoseStamped"
STRING = "std_msgs/msg/String"


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
