"""A perception node of rclpy for `ur5e_pick`, and subtly wrong ones: ``ros_perception.py [WRONG]``.

It says where a part of the first place of the tray is, seen from the camera when an image was taken: what a detector
must get right besides the detection. Transforms are looked up here, because no wheel has tf2.
"""

from __future__ import annotations

import sys
from bisect import bisect_left
from typing import Any

import numpy as np
import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.time import Time
from sensor_msgs.msg import Image
from tf2_msgs.msg import TFMessage

CAMERA, TRAY = "camera_color_optical_frame", "fixture_A"
PART = (0.0, -0.25, 0.0)
MAX_AGE_S = 0.1


def matrix(transform: Any) -> np.ndarray:
    """Return a transform as a matrix."""
    p, q = transform.translation, transform.rotation
    x, y, z, w = q.x, q.y, q.z, q.w
    made = np.eye(4)
    made[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    made[:3, 3] = (p.x, p.y, p.z)
    return made


def quaternion(turn: np.ndarray) -> tuple[float, float, float, float]:
    """Return the quaternion of a rotation, from its largest component on (Shepperd 1978)."""
    diagonal = [*turn.diagonal(), turn.trace()]
    most = int(np.argmax(diagonal))
    if most == 3:
        w = np.sqrt(1.0 + turn.trace()) / 2.0
        x, y, z = (turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]) / (4.0 * w)
        return x, y, z, w
    i, j, k = most, (most + 1) % 3, (most + 2) % 3
    parts = np.zeros(4)
    parts[i] = np.sqrt(1.0 + turn[i, i] - turn[j, j] - turn[k, k]) / 2.0
    parts[j] = (turn[j, i] + turn[i, j]) / (4.0 * parts[i])
    parts[k] = (turn[k, i] + turn[i, k]) / (4.0 * parts[i])
    parts[3] = (turn[k, j] - turn[j, k]) / (4.0 * parts[i])
    x, y, z, w = parts.tolist()
    return x, y, z, w


class Transforms:
    """Transforms by child; the one at or after a stamp answers a lookup, since the arm stands still when it looks."""

    def __init__(self, node: Any) -> None:
        self.edges: dict[str, tuple[str, list[int], list[np.ndarray]]] = {}
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(TFMessage, "/tf_static", self.take, latched)
        node.create_subscription(TFMessage, "/tf", self.take, 100)

    def take(self, message: TFMessage) -> None:
        for each in message.transforms:
            _, stamps, poses = self.edges.setdefault(each.child_frame_id, (each.header.frame_id, [], []))
            stamps.append(Time.from_msg(each.header.stamp).nanoseconds)
            poses.append(matrix(each.transform))

    def root(self, frame: str, stamp_ns: int, latest: bool) -> np.ndarray:
        """Return the pose of a frame in the root."""
        pose = np.eye(4)
        while frame in self.edges:
            frame, stamps, poses = self.edges[frame]
            at = len(stamps) - 1 if latest else min(bisect_left(stamps, stamp_ns), len(stamps) - 1)
            pose = poses[at] @ pose
        return pose


class Perception(LifecycleNode):  # type: ignore[misc]  # rclpy has no types
    """Publishes a pose for each third image, so that the tray is seen at 10 Hz."""

    def __init__(self, wrong: str) -> None:
        super().__init__("perception", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.wrong = wrong
        self.transforms = Transforms(self)

    def on_configure(self, state: Any) -> TransitionCallbackReturn:
        depth = 10 if self.wrong == "queue" else 1
        seen = QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_EFFORT)
        reliability = ReliabilityPolicy.BEST_EFFORT if self.wrong == "best_effort" else ReliabilityPolicy.RELIABLE
        self.poses = self.create_publisher(PoseStamped, "/object_pose", QoSProfile(depth=1, reliability=reliability))
        self.tf = self.create_publisher(TFMessage, "/tf", 100)
        self.create_subscription(Image, "/camera/color/image_raw", self.see, seen)
        return TransitionCallbackReturn.SUCCESS

    def see(self, image: Image) -> None:
        stamp_ns = Time.from_msg(image.header.stamp).nanoseconds
        now_ns = self.get_clock().now().nanoseconds
        if now_ns - stamp_ns > MAX_AGE_S * 1e9 and self.wrong != "stale":
            return
        if self.wrong == "dies":
            sys.exit("the detector has no weights")
        if self.wrong == "silent":
            return
        frame = self.transforms.root(TRAY, stamp_ns, latest=self.wrong == "latest")
        part = frame @ np.array([[1, 0, 0, PART[0]], [0, 1, 0, PART[1]], [0, 0, 1, PART[2]], [0, 0, 0, 1.0]])
        seen = np.linalg.inv(self.transforms.root(CAMERA, stamp_ns, latest=self.wrong == "latest")) @ part
        pose = PoseStamped()
        pose.header.stamp = self.get_clock().now().to_msg() if self.wrong == "arrival" else image.header.stamp
        pose.header.frame_id = "world" if self.wrong == "frame" else CAMERA
        scale = 1e3 if self.wrong == "millimeters" else 1.0
        pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = (scale * seen[:3, 3]).tolist()
        turned = [float("nan")] * 4 if self.wrong == "nan" else [float(part) for part in quaternion(seen[:3, :3])]
        turn = pose.pose.orientation
        turn.x, turn.y, turn.z, turn.w = turned
        self.poses.publish(pose)
        if self.wrong != "no_tf":
            self.tf.publish(transform_of(pose))


def transform_of(pose: PoseStamped) -> TFMessage:
    """Return the pose of the part as a transform."""
    from geometry_msgs.msg import TransformStamped

    made = TransformStamped(header=pose.header, child_frame_id="object")
    place = made.transform.translation
    place.x, place.y, place.z = pose.pose.position.x, pose.pose.position.y, pose.pose.position.z
    made.transform.rotation = pose.pose.orientation
    return TFMessage(transforms=[made])


def main() -> None:
    rclpy.init()
    rclpy.spin(Perception(sys.argv[1] if len(sys.argv) > 1 else ""))


if __name__ == "__main__":
    main()
