"""Requests and answers of the controllers: the fields of trajectory_msgs and control_msgs that are acted upon."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """A trajectory_msgs/JointTrajectoryPoint; an empty tuple means that the field was not given.

    Attributes:
        positions: rad or m, in the order of the trajectory's joint names.
        velocities: rad/s or m/s.
        accelerations: rad/s² or m/s².
        effort: N m or N.
        time_from_start_ns: when the point is due, counted from the start of the trajectory.
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
        accepted: all that the client is told.
        goal_id: number of the goal, counted from 1 by the manager; 0 where it was rejected.
        log_reason: why it was rejected, which in reality stands only in the controller's log.
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
