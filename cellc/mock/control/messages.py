"""What goes into the control stack and what comes out of it: requests, responses and events."""

from __future__ import annotations

from enum import IntEnum

from cellc.contract.frozen import dataclass


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """A trajectory_msgs/JointTrajectoryPoint; an empty tuple means that the field was not given.

    Attributes:
        positions: rad or m, in the order of the trajectory's joint names.
        velocities: rad/s or m/s.
        accelerations: rad/s² or m/s².
        effort: N m or N.
        time_from_start_ns: when the point is scheduled, counted from the start of the trajectory.
    """

    positions: tuple[float, ...] = ()
    velocities: tuple[float, ...] = ()
    accelerations: tuple[float, ...] = ()
    effort: tuple[float, ...] = ()
    time_from_start_ns: int = 0


@dataclass(frozen=True, slots=True)
class Trajectory:
    """A trajectory_msgs/JointTrajectory; `stamp_ns` 0 means "start when it is received"."""

    joint_names: tuple[str, ...]
    points: tuple[TrajectoryPoint, ...]
    stamp_ns: int = 0


@dataclass(frozen=True, slots=True)
class JointTolerance:
    """A control_msgs/JointTolerance: 0 keeps the controller's default, -1 erases it, other negatives are refused."""

    name: str
    position: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0


@dataclass(frozen=True, slots=True)
class TrajectoryGoal:
    """The goal of control_msgs/action/FollowJointTrajectory."""

    joint_names: tuple[str, ...]
    points: tuple[TrajectoryPoint, ...]
    stamp_ns: int = 0
    path_tolerance: tuple[JointTolerance, ...] = ()
    goal_tolerance: tuple[JointTolerance, ...] = ()
    goal_time_tolerance_ns: int = 0

    def trajectory(self) -> Trajectory:
        """The trajectory alone, as it would be sent to the controller's topic."""
        return Trajectory(self.joint_names, self.points, self.stamp_ns)


@dataclass(frozen=True, slots=True)
class GripperGoal:
    """The goal of ParallelGripperCommand, or of GripperCommand with `effort` as its max_effort.

    Attributes:
        position: m or rad; the parallel gripper controller wants exactly one.
        velocity: m/s, used only with a velocity interface configured.
        effort: N, used only with an effort interface configured.
        joint_names: never looked at by the controllers.
    """

    position: tuple[float, ...]
    velocity: tuple[float, ...] = ()
    effort: tuple[float, ...] = ()
    joint_names: tuple[str, ...] = ()


Goal = TrajectoryGoal | GripperGoal


@dataclass(frozen=True, slots=True)
class GoalResponse:
    """The answer to a goal request.

    Attributes:
        accepted: the only field that the client receives.
        goal_id: number of the goal, counted from 1 by the manager; 0 where it was rejected.
        log_reason: why it was rejected, which in reality is only in the controller's log.
    """

    accepted: bool
    goal_id: int = 0
    log_reason: str = ""


@dataclass(frozen=True, slots=True)
class CancelResponse:
    """The answer to a cancel request: action_msgs/srv/CancelGoal.

    `return_code`: 0 none, 1 rejected, 2 unknown goal, 3 goal already terminated.
    """

    return_code: int
    goals_canceling: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class ServiceResponse:
    """`ok` and `message` of a controller_manager service."""

    ok: bool
    message: str = ""


@dataclass(frozen=True, slots=True)
class HardwareStateResponse:
    """The answer of set_hardware_component_state: `state` is the state that the component is in afterwards."""

    ok: bool
    state: str = ""


@dataclass(frozen=True, slots=True)
class ParameterResponse:
    """The answer of set_parameters for one parameter."""

    successful: bool
    reason: str = ""


@dataclass(frozen=True, slots=True)
class TrajectoryStateResponse:
    """The answer of query_state."""

    success: bool
    names: tuple[str, ...] = ()
    positions: tuple[float, ...] = ()
    velocities: tuple[float, ...] = ()
    accelerations: tuple[float, ...] = ()


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
