#!/usr/bin/env python3
"""Sends a trajectory controller one small goal: one joint moves a little, every other keeps its position.

    first_goal --action NAME --states TOPIC --joint NAME --by RAD --seconds S --timeout S [--absent NODE]... \
        --then end|cancel JOINT...

It reads the joint states first, so that no other joint moves. It refuses while a motion client runs. It prints the
position of each joint before and after. It ends with 0 when the goal ended as requested. With `cancel` it cancels half
way and prints the time from the request to standstill. goal.launch.xml starts it, by a person's authorization, while
the claims hold.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

WAIT_S = 10.0  # for states and for the server
STILL = 5e-3  # rad/s or m/s; a slower joint is at standstill
SUCCEEDED, CANCELED = 4, 5  # action_msgs/msg/GoalStatus


class Robot:
    """The controller's action, and the newest state of each joint."""

    def __init__(self, action: str, states: str) -> None:
        import rclpy
        from control_msgs.action import FollowJointTrajectory
        from rclpy.action import ActionClient
        from rclpy.qos import qos_profile_sensor_data
        from sensor_msgs.msg import JointState

        rclpy.init(args=sys.argv)
        self._rclpy, self._type = rclpy, FollowJointTrajectory
        self._node = rclpy.create_node("first_goal", start_parameter_services=False)
        self._client = ActionClient(self._node, FollowJointTrajectory, action)
        self.positions: dict[str, float] = {}
        self.velocities: dict[str, float] = {}
        self._node.create_subscription(JointState, states, self._take, qos_profile_sensor_data)

    def _take(self, message: Any) -> None:
        self.positions.update(zip(message.name, message.position, strict=False))
        self.velocities.update(zip(message.name, message.velocity, strict=False))

    def spin(self, seconds: float) -> None:
        self._rclpy.spin_once(self._node, timeout_sec=seconds)

    def nodes(self) -> list[str]:
        return [f"{space.rstrip('/')}/{name}" for name, space in self._node.get_node_names_and_namespaces()]

    def serves(self) -> bool:
        return bool(self._client.server_is_ready())

    def send(self, joints: Sequence[str], positions: Sequence[float], seconds: float) -> Any:
        from builtin_interfaces.msg import Duration
        from trajectory_msgs.msg import JointTrajectoryPoint

        goal = self._type.Goal()
        goal.trajectory.joint_names = [*joints]
        whole = int(seconds)
        when = Duration(sec=whole, nanosec=round((seconds - whole) * 1e9))
        point = JointTrajectoryPoint(positions=[*positions], velocities=[0.0] * len(positions), time_from_start=when)
        goal.trajectory.points = [point]
        return self._client.send_goal_async(goal)

    def leave(self) -> None:
        self._node.destroy_node()
        self._rclpy.try_shutdown()


def awaited(robot: Any, there: Callable[[], bool], seconds: float) -> bool:
    """Spin until a condition holds; return whether it does."""
    until = time.monotonic() + seconds
    while not there() and time.monotonic() < until:
        robot.spin(0.05)
    return there()


def refused(robot: Any, asked: argparse.Namespace) -> str:
    """Return why no goal may be sent; empty where everything is ready and no motion client runs."""
    if not awaited(robot, robot.serves, WAIT_S):
        return f"no server of {asked.action}"
    if not awaited(robot, lambda: set(asked.joints) <= set(robot.positions), WAIT_S):
        return f"no state of {', '.join(sorted(set(asked.joints) - set(robot.positions)))} on {asked.states}"
    there = ", ".join(name for name in asked.absent if name in robot.nodes())
    return f"end {there} first: a motion client may not run" if there else ""


def moving(robot: Any, joints: Sequence[str]) -> bool:
    return any(abs(robot.velocities.get(name, 0.0)) > STILL for name in joints)


def canceled(robot: Any, handle: Any, joints: Sequence[str], after_s: float, bound_s: float) -> None:
    """Cancel half way; print the time from the request to standstill."""
    awaited(robot, lambda: False, after_s)
    asked = last = time.monotonic()
    handle.cancel_goal_async()
    while time.monotonic() < asked + bound_s:
        robot.spin(0.02)
        if moving(robot, joints):
            last = time.monotonic()
    print(f"canceled: standstill {last - asked:.3f} s after the request", flush=True)


def print_motion(before: Mapping[str, float], after: Mapping[str, float], joints: Sequence[str]) -> None:
    for name in joints:
        print(
            f"{name}: {before[name]:.4f} before, {after[name]:.4f} after, {after[name] - before[name]:+.4f}", flush=True
        )


def send(robot: Any, asked: argparse.Namespace) -> str:
    """Send the goal and wait for its end; return why that failed, or an empty text."""
    before = dict(robot.positions)
    target = [before[name] + (asked.by if name == asked.joint else 0.0) for name in asked.joints]
    sent = robot.send(asked.joints, target, asked.seconds)
    if not awaited(robot, sent.done, WAIT_S) or not sent.result().accepted:
        return f"{asked.action} did not accept the goal"
    handle = sent.result()
    ended = handle.get_result_async()
    if asked.then == "cancel":
        canceled(robot, handle, asked.joints, asked.seconds / 2.0, asked.timeout)
    if not awaited(robot, ended.done, asked.timeout):
        handle.cancel_goal_async()
        awaited(robot, ended.done, asked.timeout)
        return f"the goal did not end within {asked.timeout:g} s and was canceled"
    print_motion(before, robot.positions, asked.joints)
    answer, expected = ended.result(), CANCELED if asked.then == "cancel" else SUCCEEDED
    said = f"status {answer.status}, error_code {answer.result.error_code} {answer.result.error_string}".rstrip()
    print(said, flush=True)
    return "" if answer.status == expected else f"unexpected result: {said}"


def arguments_of(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--action", required=True)
    parser.add_argument("--states", required=True)
    parser.add_argument("--joint", required=True, help="joint that moves")
    parser.add_argument("--by", type=float, required=True, help="rad or m, with its sign")
    parser.add_argument("--seconds", type=float, required=True, help="duration of the motion")
    parser.add_argument("--timeout", type=float, required=True, help="seconds until the goal must end")
    parser.add_argument("--absent", action="append", default=[], help="node that may not run")
    parser.add_argument("--then", choices=("end", "cancel"), default="end")
    parser.add_argument("joints", nargs="+", help="all joints of the controller")
    options = [*words[: words.index("--ros-args")]] if "--ros-args" in words else [*words]
    return parser.parse_args(options)


def main(words: Sequence[str]) -> int:
    """Check, send, print; return the exit status."""
    asked = arguments_of(words)
    robot = Robot(asked.action, asked.states)
    try:
        why = refused(robot, asked) or send(robot, asked)
    finally:
        robot.leave()
    if why:
        print(f"first_goal failed: {why}", file=sys.stderr, flush=True)
    return 1 if why else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
