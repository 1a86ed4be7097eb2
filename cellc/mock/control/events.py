"""What the control stack tells the outside: ended goals, feedback, changed states."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

Vector = tuple[float, ...]


class GoalStatus(IntEnum):
    """Terminal status of a goal, by action_msgs/msg/GoalStatus."""

    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6


@dataclass(frozen=True, slots=True)
class TrajectoryEnded:
    """The result of a FollowJointTrajectory goal reached its client.

    Attributes:
        stamp_ns: time of delivery, which is a tick of the action monitor except on preemption.
        decided_ns: time of the update cycle or request that decided it.
        controller: name of the controller.
        goal_id: the goal's number.
        status: terminal status.
        error_code: 0 successful, -1 invalid goal (preempted, deactivated), -4 path, -5 goal tolerance violated.
        error_string: as the controller words it.
    """

    stamp_ns: int
    decided_ns: int
    controller: str
    goal_id: int
    status: GoalStatus
    error_code: int
    error_string: str


@dataclass(frozen=True, slots=True)
class GripperEnded:
    """The result of a gripper goal reached its client; position and effort are empty in an empty result."""

    stamp_ns: int
    decided_ns: int
    controller: str
    goal_id: int
    status: GoalStatus
    position: Vector
    effort: Vector
    stalled: bool
    reached_goal: bool


@dataclass(frozen=True, slots=True)
class TrajectoryFeedback:
    """Feedback of a FollowJointTrajectory goal, sent on ticks of the action monitor.

    Attributes:
        stamp_ns: time of sending.
        sampled_ns: time of the update cycle that the values belong to (`header.stamp`).
        controller: name of the controller.
        goal_id: the goal's number.
        index: point of the trajectory that the motion comes from (control_msgs 6 and newer).
        time_from_start_ns: of `desired`, in the time of the trajectory.
        desired, actual, error: positions in the order of the controller's joints.
    """

    stamp_ns: int
    sampled_ns: int
    controller: str
    goal_id: int
    index: int
    time_from_start_ns: int
    desired: Vector
    actual: Vector
    error: Vector


@dataclass(frozen=True, slots=True)
class ControllerChanged:
    """A controller changed its lifecycle state; `reason` is empty where it was asked to."""

    stamp_ns: int
    controller: str
    state: str
    reason: str = ""


@dataclass(frozen=True, slots=True)
class HardwareChanged:
    """A hardware component changed its lifecycle state; `reason` is empty where it was asked to."""

    stamp_ns: int
    component: str
    state: str
    reason: str = ""


GoalEnded = TrajectoryEnded | GripperEnded
ControlEvent = TrajectoryEnded | GripperEnded | TrajectoryFeedback | ControllerChanged | HardwareChanged
