"""A task node of rclpy that hears what the contract has it hear, and sends no goal: a person does, by `ros2 action`."""

from __future__ import annotations

import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import JointState


def main() -> None:
    """Hear until somebody ends it."""
    rclpy.init()
    node = Node("task")
    node.create_subscription(JointState, "/joint_states", lambda _: None, 1)
    node.create_subscription(PoseStamped, "/object_pose", lambda _: None, 1)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        return


if __name__ == "__main__":
    main()
