"""Messages and definitions, byte by byte against an independent implementation of both."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import Distro
from cellc.mock.control import GripperGoal, Trajectory, TrajectoryPoint
from cellc.mock.evidence.bag import messages
from cellc.mock.evidence.bag.bag_file import schema
from cellc.mock.evidence.bag.messages import CONTROLLER_STATE, Point, controller_state_rows, joint_state_shape
from tests.oracles import UPSTREAM, needs_upstream

STANDARD = (
    messages.JOINT_STATE,
    messages.TF_MESSAGE,
    messages.JOINT_TRAJECTORY,
    messages.DIAGNOSTIC_ARRAY,
    messages.POSE_STAMPED,
    messages.STRING,
)
POSE = Pose((0.1, -0.2, 0.3), (0.0, 0.0, 0.6, 0.8))
STORES = {Distro.HUMBLE: Stores.ROS2_HUMBLE, Distro.JAZZY: Stores.ROS2_JAZZY, Distro.KILTED: Stores.ROS2_KILTED}


class Peer:
    """Encodes and decodes with rosbags."""

    def __init__(self, distro: Distro = Distro.JAZZY) -> None:
        self.store = get_typestore(STORES[distro])
        types = get_types_from_msg(schema(CONTROLLER_STATE, distro), CONTROLLER_STATE)
        self.store.register({name: fields for name, fields in types.items() if name not in self.store.fielddefs})

    def make(self, name: str, *values: Any) -> Any:
        package, kind = name.split("/")
        return self.store.types[f"{package}/msg/{kind}"](*values)

    def encode(self, message: Any, name: str) -> bytes:
        return bytes(self.store.serialize_cdr(message, name))

    def header(self, stamp_ns: int, frame: str = "") -> Any:
        time = self.make("builtin_interfaces/Time", stamp_ns // 10**9, stamp_ns % 10**9)
        return self.make("std_msgs/Header", time, frame)

    def point(self, time_ns: int = 0, **fields: list[float]) -> Any:
        values = [np.array(fields.get(name, [])) for name in ("positions", "velocities", "accelerations", "effort")]
        return self.make("trajectory_msgs/JointTrajectoryPoint", *values, self.duration(time_ns))

    def duration(self, time_ns: int) -> Any:
        return self.make("builtin_interfaces/Duration", time_ns // 10**9, time_ns % 10**9)


@pytest.fixture(scope="module")
def peer() -> Peer:
    return Peer()


@pytest.mark.parametrize("distro", sorted(STORES))
@pytest.mark.parametrize("name", STANDARD)
def test_definition_has_the_type_hash_of_the_distribution(name: str, distro: Distro) -> None:
    """RIHS01 is taken over every field of a type and of the types in it."""
    reference = get_typestore(STORES[distro])
    ours = get_typestore(Stores.EMPTY)
    ours.register(get_types_from_msg(schema(name, distro), name))
    assert ours.hash_rihs01(name) == reference.hash_rihs01(name)


@needs_upstream
def test_controller_state_is_the_recorded_one() -> None:
    text = (UPSTREAM / "interfaces/control_msgs/msg/JointTrajectoryControllerState.msg").read_text(encoding="utf-8")
    recorded = [line.split() for line in text.splitlines() if line and not line.startswith("#")]
    ours = schema(CONTROLLER_STATE, "jazzy").split("=" * 80)[0]
    assert [line.split() for line in ours.splitlines()] == recorded


def test_humble_has_desired_and_actual_and_no_scaling() -> None:
    text = schema(CONTROLLER_STATE, "humble").split("=" * 80)[0]
    assert "JointTrajectoryPoint desired" in text
    assert "speed_scaling_factor" not in text


def test_string_is_encoded_as_by_the_peer(peer: Peer) -> None:
    for text in ("", "a", "é…", "{}" * 20):
        assert messages.string(text) == peer.encode(peer.make("std_msgs/String", text), messages.STRING)


def test_transforms_are_encoded_as_by_the_peer(peer: Peer) -> None:
    ours = [messages.StampedTransform(1_500_000_007, "world", child, POSE) for child in ("a", "bcd", "gripper")]
    vector = peer.make("geometry_msgs/Vector3", *POSE.position)
    transform = peer.make("geometry_msgs/Transform", vector, peer.make("geometry_msgs/Quaternion", *POSE.quaternion))
    theirs = [
        peer.make("geometry_msgs/TransformStamped", peer.header(each.stamp_ns, "world"), each.child, transform)
        for each in ours
    ]
    expected = peer.encode(peer.make("tf2_msgs/TFMessage", theirs), messages.TF_MESSAGE)
    assert messages.transforms(ours) == expected


def test_pose_is_encoded_as_by_the_peer(peer: Peer) -> None:
    point = peer.make("geometry_msgs/Point", *POSE.position)
    pose = peer.make("geometry_msgs/Pose", point, peer.make("geometry_msgs/Quaternion", *POSE.quaternion))
    theirs = peer.make("geometry_msgs/PoseStamped", peer.header(3, "camera"), pose)
    assert messages.pose_stamped(3, "camera", POSE) == peer.encode(theirs, messages.POSE_STAMPED)


def test_trajectory_is_encoded_as_by_the_peer(peer: Peer) -> None:
    points = (
        TrajectoryPoint(positions=(0.1, 0.2), velocities=(1.0, 2.0), time_from_start_ns=1_250_000_000),
        TrajectoryPoint(positions=(0.3, 0.4), accelerations=(5.0, 6.0), effort=(7.0, 8.0), time_from_start_ns=1),
    )
    theirs = peer.make(
        "trajectory_msgs/JointTrajectory",
        peer.header(9),
        ["j", "joint_2"],
        [
            peer.point(1_250_000_000, positions=[0.1, 0.2], velocities=[1.0, 2.0]),
            peer.point(1, positions=[0.3, 0.4], accelerations=[5.0, 6.0], effort=[7.0, 8.0]),
        ],
    )
    ours = messages.joint_trajectory(Trajectory(("j", "joint_2"), points, stamp_ns=9))
    assert ours == peer.encode(theirs, messages.JOINT_TRAJECTORY)


def test_gripper_goal_is_encoded_as_by_the_peer(peer: Peer) -> None:
    arrays = [np.array([0.8]), np.array([]), np.array([40.0])]
    theirs = peer.make("sensor_msgs/JointState", peer.header(5), ["finger"], *arrays)
    ours = messages.gripper_command(5, ("finger",), GripperGoal((0.8,), effort=(40.0,)))
    assert ours == peer.encode(theirs, messages.JOINT_STATE)


def test_diagnostics_are_encoded_as_by_the_peer(peer: Peer) -> None:
    ours = [messages.DiagnosticStatus(2, "manager: x", "not all", (("arm", "inactive"), ("g", "active")))]
    values = [peer.make("diagnostic_msgs/KeyValue", *pair) for pair in ours[0].values]
    status = peer.make("diagnostic_msgs/DiagnosticStatus", 2, "manager: x", "not all", "", values)
    theirs = peer.make("diagnostic_msgs/DiagnosticArray", peer.header(7), [status])
    assert messages.diagnostics(7, ours) == peer.encode(theirs, messages.DIAGNOSTIC_ARRAY)


def test_rows_of_joint_states_are_encoded_as_by_the_peer(peer: Peer) -> None:
    stamps = np.array([0, 2_000_000, 3_999_999_999])
    numbers = [np.arange(6.0).reshape(3, 2) + offset for offset in (0.0, 0.25, np.nan)]
    rows = joint_state_shape(("a", "longer_name")).encode(stamps, numbers)
    for row, stamp_ns, *values in zip(rows, stamps.tolist(), *numbers, strict=True):
        theirs = peer.make("sensor_msgs/JointState", peer.header(stamp_ns), ["a", "longer_name"], *values)
        assert row == peer.encode(theirs, messages.JOINT_STATE)


@pytest.mark.parametrize("distro", [Distro.HUMBLE, Distro.JAZZY])
def test_rows_of_controller_states_are_encoded_as_by_the_peer(distro: Distro) -> None:
    peer = Peer(distro)
    value = np.array([[1.0, 2.0, 3.0]])
    points: tuple[Point, ...] = (
        {"positions": value, "velocities": 2 * value},
        {"positions": 3 * value},
        {"velocities": 4 * value},
        {},
    )
    shape, numbers = controller_state_rows(("a", "bb", "c"), points, np.array([0.5]), distro)
    (row,) = shape.encode(np.array([11]), numbers)
    theirs = [peer.point(**{name: array[0].tolist() for name, array in point.items()}) for point in points]
    repeated = theirs[:2] if distro is Distro.HUMBLE else []
    empty = peer.make("trajectory_msgs/MultiDOFJointTrajectoryPoint", [], [], [], peer.duration(0))
    values = [peer.header(11), ["a", "bb", "c"], *theirs, *repeated, [], *[empty] * (4 + len(repeated))]
    values += [] if distro is Distro.HUMBLE else [0.5]
    message = peer.make("control_msgs/JointTrajectoryControllerState", *values)
    assert row == peer.encode(message, CONTROLLER_STATE)
