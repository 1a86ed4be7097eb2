"""Bags of a UR5e cell that rosbags writes, with messages made by hand: nothing of the mock or of its writer is in them.

Definitions are those that rosbags ships for the distribution, or the text of the vendor's package.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tests.cells import generated
from tests.cli.run import Ran, run

JOINTS = tuple(
    f"arm_{name}_joint" for name in ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
)
FINGER = "gripper_robotiq_85_left_knuckle_joint"
MOVE = "/arm_trajectory/follow_joint_trajectory/_action/status"
PLAN = "/move_action/_action/status"
SAFETY = "/arm_io/safety_mode"
EXECUTING, CANCELING, SUCCEEDED, CANCELED, ABORTED = 2, 3, 4, 5, 6
"""action_msgs/msg/GoalStatus."""
BEGIN_NS = 1_790_000_000_000_000_000
MS = 1_000_000
STORE = get_typestore(Stores.ROS2_JAZZY)
STORE.register(get_types_from_msg("uint8 mode\n", "ur_dashboard_msgs/msg/SafetyMode"))
STATE = "control_msgs/msg/JointTrajectoryControllerState"
_PARTS = ("reference", "feedback", "error", "output")
STORE.register(
    get_types_from_msg(
        "std_msgs/Header header\nstring[] joint_names\n"
        + "".join(f"trajectory_msgs/JointTrajectoryPoint {part}\n" for part in _PARTS)
        + "string[] multi_dof_joint_names\n"
        + "".join(f"trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_{part}\n" for part in _PARTS)
        + "float64 speed_scaling_factor\n",
        STATE,
    )
)
"""As control_msgs 5 has it."""


def made(kind: str, **values: Any) -> Any:
    """Return a message of a type."""
    return STORE.types[kind](**values)


def stamp(at_ns: int) -> Any:
    """Return a builtin_interfaces/Time."""
    return made("builtin_interfaces/msg/Time", sec=at_ns // 10**9, nanosec=at_ns % 10**9)


@dataclass
class HandMade:
    """Messages with the time of their arrival in ns from the begin."""

    messages: list[tuple[int, str, str, Any]] = field(default_factory=list)

    def add(self, at_ns: int, topic: str, kind: str, message: Any) -> None:
        """Add a message."""
        self.messages.append((BEGIN_NS + at_ns, topic, kind, message))

    def joints(self, at_ns: int, positions: list[float], names: tuple[str, ...] = (*JOINTS, FINGER)) -> None:
        """Add a joint state that arrives as it is stamped."""
        header = made("std_msgs/msg/Header", stamp=stamp(BEGIN_NS + at_ns), frame_id="")
        values, none = np.array(positions, dtype=np.float64), np.empty(0, dtype=np.float64)
        kind = "sensor_msgs/msg/JointState"
        state = made(kind, header=header, name=list(names), position=values, velocity=none, effort=none)
        self.add(at_ns, "/joint_states", kind, state)

    def follows(self, at_ns: int, reference: float, feedback: float, scaling: float) -> None:
        """Add a state of the controller, all joints of the arm alike."""
        never = made("builtin_interfaces/msg/Duration", sec=0, nanosec=0)
        values = {"reference": reference, "feedback": feedback, "error": reference - feedback, "output": reference}
        none = np.empty(0, dtype=np.float64)
        rest = {"velocities": none, "accelerations": none, "effort": none, "time_from_start": never}
        kind = "trajectory_msgs/msg/JointTrajectoryPoint"
        points = {part: made(kind, positions=np.full(len(JOINTS), value), **rest) for part, value in values.items()}
        kind = "trajectory_msgs/msg/MultiDOFJointTrajectoryPoint"
        empty = made(kind, transforms=[], velocities=[], accelerations=[], time_from_start=never)
        state = made(
            STATE,
            header=made("std_msgs/msg/Header", stamp=stamp(BEGIN_NS + at_ns), frame_id=""),
            joint_names=list(JOINTS),
            multi_dof_joint_names=[],
            speed_scaling_factor=scaling,
            **points,
            **{f"multi_dof_{part}": empty for part in _PARTS},
        )
        self.add(at_ns, "/arm_trajectory/controller_state", STATE, state)

    def goal(self, at_ns: int, topic: str, number: int, accepted_ns: int, status: int) -> None:
        """Add the status of an action with one goal."""
        uuid = made("unique_identifier_msgs/msg/UUID", uuid=np.full(16, number, dtype=np.uint8))
        info = made("action_msgs/msg/GoalInfo", goal_id=uuid, stamp=stamp(BEGIN_NS + accepted_ns))
        state = made("action_msgs/msg/GoalStatus", goal_info=info, status=status)
        kind = "action_msgs/msg/GoalStatusArray"
        self.add(at_ns, topic, kind, made(kind, status_list=[state]))

    def safety(self, at_ns: int, mode: int) -> None:
        """Add a ur_dashboard_msgs/SafetyMode: 1 is NORMAL, 3 is PROTECTIVE_STOP, 7 is ROBOT_EMERGENCY_STOP."""
        kind = "ur_dashboard_msgs/msg/SafetyMode"
        self.add(at_ns, SAFETY, kind, made(kind, mode=mode))

    def says(self, at_ns: int, node: str, text: str, level: int = 40) -> None:
        """Add a line of a log."""
        kind = "rcl_interfaces/msg/Log"
        where = {"file": "", "function": "", "line": 0}
        self.add(at_ns, "/rosout", kind, made(kind, stamp=stamp(0), level=level, name=node, msg=text, **where))

    def begin_move(self) -> None:
        """Add a move that was planned from 100 ms on and accepted at 150 ms, while nothing was stopped."""
        self.safety(0, 1)
        self.goal(100 * MS, PLAN, 1, 100 * MS, EXECUTING)
        self.goal(150 * MS, MOVE, 2, 150 * MS, EXECUTING)

    def end_move(self, at_ns: int, status: int, canceled_ns: int | None = None) -> None:
        """Add the end of that move; the planner says so 5 ms later."""
        if canceled_ns is not None:
            self.goal(canceled_ns, MOVE, 2, 150 * MS, CANCELING)
        self.goal(at_ns, MOVE, 2, 150 * MS, status)
        self.goal(at_ns + 5 * MS, PLAN, 1, 100 * MS, status)

    def write(
        self, folder: Path, plugin: StoragePlugin = StoragePlugin.MCAP, begin: int = 0, end: int | None = None
    ) -> Path:
        """Write the messages, or some of them, as a bag."""
        chosen = sorted(self.messages, key=lambda each: each[0])[begin:end]
        with Writer(folder, version=9, storage_plugin=plugin) as writer:
            kinds = {topic: kind for _, topic, kind, _ in chosen}
            opened = {topic: writer.add_connection(topic, kind, typestore=STORE) for topic, kind in kinds.items()}
            for at_ns, topic, kind, message in chosen:
                writer.write(opened[topic], at_ns, STORE.serialize_cdr(message, kind))
        return folder


def moving(bag: HandMade, until_ns: int, speed: Callable[[int], float]) -> Iterator[int]:
    """Add joint states at 500 Hz; the elbow moves at a speed in rad/s; yield the time of each."""
    elbow = 1.5
    for at_ns in range(0, until_ns, 2 * MS):
        elbow += speed(at_ns) * 0.002
        bag.joints(at_ns, [0.0, -1.5, elbow, -1.5, -1.5, 0.0, 0.0])
        yield at_ns


def protective_stop() -> HandMade:
    """Return a move that was planned from 100 ms on and accepted at 150 ms; a protective stop ended it at 600 ms.

    The arm moves from 160 ms on and stands from 620 ms on; its driver publishes the mode at 600 ms and aborts the goal
    at 700 ms; move_group aborts at 710 ms, and the task says so at 720 ms.
    """
    bag = HandMade()
    for _ in moving(bag, 1000 * MS, lambda at_ns: 0.5 if 160 * MS < at_ns <= 620 * MS else 0.0):
        pass
    bag.begin_move()
    bag.safety(600 * MS, 3)
    bag.goal(700 * MS, MOVE, 2, 150 * MS, ABORTED)
    bag.says(700 * MS, "arm_trajectory", "-4: path tolerance violated")
    bag.goal(710 * MS, PLAN, 1, 100 * MS, ABORTED)
    bag.says(720 * MS, "task", "the move failed")
    return bag


def arrived() -> HandMade:
    """Return a move that was planned from 100 ms on, accepted at 150 ms, driven from 162 ms on and ended at 500 ms."""
    bag = HandMade()
    for _ in moving(bag, 800 * MS, lambda at_ns: 0.5 if 160 * MS < at_ns < 480 * MS else 0.0):
        pass
    bag.begin_move()
    bag.end_move(500 * MS, SUCCEEDED)
    return bag


def attempted(*bags: Path, task: str | None = None, form: str = "json") -> Ran:
    """Run the command on bags of the cell."""
    named = () if task is None else ("--task", task)
    files = [bag.as_posix() for bag in bags]
    return run("attempt", *files, "--package", generated("ur5e_pick").as_posix(), *named, "--format", form)
