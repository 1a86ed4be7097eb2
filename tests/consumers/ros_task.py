"""A task node of rclpy, and subtly wrong ones: ``ros_task.py FOLDER REHEARSAL [WRONG]``.

It takes the steps of a rehearsal of a generated folder. What it decides is in `tests.mock.ros.task_program`; here is
what it hears and sends. Transforms are looked up here, because no wheel has tf2.
"""

from __future__ import annotations

import json
import math
import sys
import time
from bisect import bisect_left
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import rclpy
from action_msgs.msg import GoalStatus
from control_msgs.action import ParallelGripperCommand
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import PoseStamped
from moveit_msgs.action import MoveGroup
from moveit_msgs.msg import Constraints, JointConstraint, MoveItErrorCodes, OrientationConstraint, PositionConstraint
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from sensor_msgs.msg import JointState
from shape_msgs.msg import SolidPrimitive
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

from cellc.contract.transforms import Pose, identity
from tests.mock.ros.task_program import Program, Seen, States

_TICK_S = 0.02


class Goal:
    """A goal of an action, from its sending on."""

    def __init__(self, client: ActionClient, goal: Any) -> None:
        self.status: int | None = None
        self.good = False
        self._handle: Any = None
        self._canceled = False
        client.send_goal_async(goal).add_done_callback(self._answered)

    def cancel(self) -> None:
        """Ask for the end of it, as soon as it is known."""
        self._canceled = True
        if self._handle is not None:
            self._handle.cancel_goal_async()

    def _answered(self, future: Any) -> None:
        self._handle = future.result()
        if not self._handle.accepted:
            self.status = -1
            return
        self._handle.get_result_async().add_done_callback(self._ended)
        if self._canceled:
            self._handle.cancel_goal_async()

    def _ended(self, future: Any) -> None:
        answer = future.result()
        code = getattr(answer.result, "error_code", None)
        self.good = code is None or code.val == MoveItErrorCodes.SUCCESS
        self.status = answer.status


class Transforms:
    """Transforms by child, interpolated between their stamps."""

    def __init__(self, node: Node) -> None:
        self._edges: dict[str, tuple[str, list[int], list[Pose]]] = {}
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(TFMessage, "/tf_static", self._take, latched)
        node.create_subscription(TFMessage, "/tf", self._take, 100)

    def _take(self, message: TFMessage) -> None:
        for each in message.transforms:
            _, stamps, poses = self._edges.setdefault(each.child_frame_id, (each.header.frame_id, [], []))
            p, q = each.transform.translation, each.transform.rotation
            stamps.append(Time.from_msg(each.header.stamp).nanoseconds)
            poses.append(Pose((p.x, p.y, p.z), (q.x, q.y, q.z, q.w)))

    def root(self, frame: str, stamp_ns: int) -> Pose:
        """Return a frame in the root, 0 for the latest."""
        pose = identity()
        while frame in self._edges:
            frame, stamps, poses = self._edges[frame]
            pose = _between(stamps, poses, stamp_ns) @ pose
        return pose

    def latest_ns(self, frame: str) -> int:
        """Return up to when the way from a frame to the root is known."""
        latest = []
        while frame in self._edges:
            frame, stamps, _ = self._edges[frame]
            latest += [stamps[-1]] if stamps[-1] else []
        return min(latest, default=0)


def _between(stamps: list[int], poses: list[Pose], stamp_ns: int) -> Pose:
    if stamp_ns == 0 or stamp_ns >= stamps[-1]:
        return poses[-1]
    at = bisect_left(stamps, stamp_ns)
    if at == 0:
        return poses[0]
    share = (stamp_ns - stamps[at - 1]) / (stamps[at] - stamps[at - 1])
    a, b = poses[at - 1], poses[at]
    sign = 1.0 if sum(x * y for x, y in zip(a.quaternion, b.quaternion, strict=True)) >= 0.0 else -1.0
    turn = [x + share * (sign * y - x) for x, y in zip(a.quaternion, b.quaternion, strict=True)]
    norm = math.sqrt(sum(part * part for part in turn))
    qx, qy, qz, qw = (part / norm for part in turn)
    x, y, z = (x + share * (y - x) for x, y in zip(a.position, b.position, strict=True))
    return Pose((x, y, z), (qx, qy, qz, qw))


class Task(Node):  # type: ignore[misc]  # rclpy has no types
    """The node."""

    def __init__(self, contract: Mapping[str, Any], steps: Any, wrong: str) -> None:
        super().__init__("task", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.states: States | None = None
        self.observed: Seen | None = None
        self.canceled = self.acknowledged = False
        self.transforms = Transforms(self)
        self._wrong = wrong
        self._moves = ActionClient(self, MoveGroup, "/move_action")
        self._grips = ActionClient(self, ParallelGripperCommand, "/gripper_action/gripper_cmd")
        self.create_subscription(JointState, "/joint_states", self._take_states, 1)
        self.create_subscription(PoseStamped, "/object_pose", self._take_pose, 1)
        self.create_service(Trigger, "~/cancel", self._cancel)
        self.create_service(Trigger, "~/acknowledge", self._acknowledge)
        self._program = Program(self, contract, steps, wrong).run()
        self.create_timer(_TICK_S, self._tick)

    @property
    def now_ns(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _tick(self) -> None:
        if self._moves.server_is_ready() and self._grips.server_is_ready():
            next(self._program, None)

    def _take_states(self, message: JointState) -> None:
        stamp_ns = Time.from_msg(message.header.stamp).nanoseconds
        self.states = States(stamp_ns, self.now_ns, dict(zip(message.name, message.position, strict=True)))

    def _take_pose(self, message: PoseStamped) -> None:
        p, q = message.pose.position, message.pose.orientation
        if not math.isfinite(p.x):
            if self._wrong == "dies":
                sys.exit("position is no number")
            return
        stamp_ns, pose = Time.from_msg(message.header.stamp).nanoseconds, Pose((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))
        self.observed = Seen(stamp_ns, self.now_ns, message.header.frame_id, pose)

    def _cancel(self, _: Any, response: Any) -> Any:
        self.canceled = response.success = True
        return response

    def _acknowledge(self, _: Any, response: Any) -> Any:
        self.acknowledged = response.success = True
        return response

    def is_known(self, frame: str, stamp_ns: int) -> bool:
        """Tell whether transforms of a frame have come up to a stamp."""
        return self.transforms.latest_ns(frame) >= stamp_ns

    def in_world(self, frame: str, stamp_ns: int) -> Pose:
        return self.transforms.root(frame, stamp_ns)

    def move_joints(self, group: str, positions: Mapping[str, float]) -> Goal:
        joints = [
            JointConstraint(joint_name=joint, position=at, tolerance_above=1e-3, tolerance_below=1e-3, weight=1.0)
            for joint, at in positions.items()
        ]
        return self._move(group, Constraints(joint_constraints=joints))

    def move_tip(self, group: str, link: str, frame: str, pose: Pose) -> Goal:
        at = PoseMessage()
        at.position.x, at.position.y, at.position.z = pose.position
        turn = OrientationConstraint(link_name=link, weight=1.0)
        turn.orientation.x, turn.orientation.y, turn.orientation.z, turn.orientation.w = pose.quaternion
        place = PositionConstraint(link_name=link, weight=1.0)
        place.constraint_region.primitives = [SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[1e-4])]
        place.constraint_region.primitive_poses = [at]
        place.header.frame_id = turn.header.frame_id = frame
        return self._move(group, Constraints(position_constraints=[place], orientation_constraints=[turn]))

    def _move(self, group: str, constraints: Constraints) -> Goal:
        goal = MoveGroup.Goal()
        goal.request.group_name = group
        goal.request.goal_constraints = [constraints]
        goal.request.allowed_planning_time = 5.0
        sent = Goal(self._moves, goal)
        if self._wrong == "blocks":
            while sent.status is None:  # nothing of this node runs meanwhile: it never ends
                time.sleep(0.01)
        return sent

    def grip(self, joint: str, position: float) -> Goal:
        goal = ParallelGripperCommand.Goal()
        goal.command.name, goal.command.position = [joint], [position]
        return Goal(self._grips, goal)


def main() -> None:
    folder, rehearsal, *wrong = sys.argv[1:]
    contract = json.loads((Path(folder) / "contract.json").read_text())
    known = json.loads((Path(folder) / "rehearsals.json").read_text())["rehearsals"]
    steps = next(each["steps"] for each in known if each["name"] == rehearsal)
    assert GoalStatus.STATUS_SUCCEEDED == 4
    rclpy.init()
    try:
        rclpy.spin(Task(contract, steps, wrong[0] if wrong else ""))
    except (KeyboardInterrupt, ExternalShutdownException):
        return


if __name__ == "__main__":
    main()
