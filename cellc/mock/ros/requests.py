"""Reads what clients ask of actions, field by field as the ROS side sends it, and writes what they are answered."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from cellc.contract.transforms import Pose
from cellc.mock.control import (
    GripperEnded,
    GripperGoal,
    JointTolerance,
    TrajectoryEnded,
    TrajectoryGoal,
    TrajectoryPoint,
)
from cellc.mock.control.messages import TrajectoryFeedback
from cellc.mock.ros.incoming import MalformedMessageError
from cellc.robot.planning import TimedTrajectory

FOLLOW_JOINT_TRAJECTORY = "control_msgs/action/FollowJointTrajectory"
GRIPPER_COMMAND = "control_msgs/action/GripperCommand"
PARALLEL_GRIPPER_COMMAND = "control_msgs/action/ParallelGripperCommand"
MOVE_GROUP = "moveit_msgs/action/MoveGroup"
_NANOSECONDS = 1_000_000_000


class _Message(BaseModel):
    """A message; fields that nothing is done with are left out."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class _Time(_Message):
    sec: int = 0
    nanosec: int = 0

    @property
    def ns(self) -> int:
        """The time in ns."""
        return self.sec * _NANOSECONDS + self.nanosec


class Header(_Message):
    """A std_msgs/Header."""

    stamp: _Time = _Time()
    frame_id: str = ""


class _JointPoint(_Message):
    positions: tuple[float, ...] = ()
    velocities: tuple[float, ...] = ()
    accelerations: tuple[float, ...] = ()
    effort: tuple[float, ...] = ()
    time_from_start: _Time = _Time()

    def point(self) -> TrajectoryPoint:
        """Return the point as controllers take it."""
        time_ns = self.time_from_start.ns
        return TrajectoryPoint(self.positions, self.velocities, self.accelerations, self.effort, time_ns)


class _JointTrajectory(_Message):
    header: Header = Header()
    joint_names: tuple[str, ...] = ()
    points: tuple[_JointPoint, ...] = ()


class _Tolerance(_Message):
    name: str
    position: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0

    def tolerance(self) -> JointTolerance:
        """Return the tolerance as controllers take it."""
        return JointTolerance(self.name, self.position, self.velocity, self.acceleration)


class _FollowJointTrajectory(_Message):
    trajectory: _JointTrajectory
    path_tolerance: tuple[_Tolerance, ...] = ()
    goal_tolerance: tuple[_Tolerance, ...] = ()
    goal_time_tolerance: _Time = _Time()

    def goal(self) -> TrajectoryGoal:
        """Return the goal as controllers take it."""
        return TrajectoryGoal(
            self.trajectory.joint_names,
            tuple(each.point() for each in self.trajectory.points),
            self.trajectory.header.stamp.ns,
            tuple(each.tolerance() for each in self.path_tolerance),
            tuple(each.tolerance() for each in self.goal_tolerance),
            self.goal_time_tolerance.ns,
        )


class _Command(_Message):
    position: float = 0.0
    max_effort: float = 0.0


class _GripperCommand(_Message):
    command: _Command

    def goal(self) -> GripperGoal:
        """Return the goal as controllers take it."""
        return GripperGoal((self.command.position,), effort=(self.command.max_effort,))


class _JointState(_Message):
    name: tuple[str, ...] = ()
    position: tuple[float, ...] = ()
    velocity: tuple[float, ...] = ()
    effort: tuple[float, ...] = ()


class _ParallelGripperCommand(_Message):
    command: _JointState

    def goal(self) -> GripperGoal:
        """Return the goal as controllers take it."""
        return GripperGoal(self.command.position, self.command.velocity, self.command.effort, self.command.name)


class _Point(_Message):
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


class _Quaternion(_Point):
    w: float = 1.0


class _Place(_Message):
    position: _Point = _Point()


class _Region(_Message):
    primitive_poses: tuple[_Place, ...] = ()


class JointConstraint(_Message):
    """A moveit_msgs/JointConstraint, rad or m."""

    joint_name: str
    position: float


class _PositionConstraint(_Message):
    header: Header
    link_name: str
    target_point_offset: _Point = _Point()
    constraint_region: _Region = _Region()


class _OrientationConstraint(_Message):
    header: Header
    link_name: str
    orientation: _Quaternion


class Constraints(_Message):
    """A moveit_msgs/Constraints: joints, or the pose of a link in a frame."""

    joint_constraints: tuple[JointConstraint, ...] = ()
    position_constraints: tuple[_PositionConstraint, ...] = ()
    orientation_constraints: tuple[_OrientationConstraint, ...] = ()

    def link_pose(self) -> tuple[str, str, Pose] | None:
        """Return a link, a frame, and where the link is to be in it; None where they do not state one whole pose."""
        if len(self.position_constraints) != 1 or len(self.orientation_constraints) != 1:
            return None
        place, turn = self.position_constraints[0], self.orientation_constraints[0]
        same = (place.link_name, place.header.frame_id) == (turn.link_name, turn.header.frame_id)
        poses, offset = place.constraint_region.primitive_poses, place.target_point_offset
        if not same or len(poses) != 1 or any((offset.x, offset.y, offset.z)):
            return None
        at, q = poses[0].position, turn.orientation
        return place.link_name, place.header.frame_id, Pose((at.x, at.y, at.z), (q.x, q.y, q.z, q.w))


class _PlanRequest(_Message):
    group_name: str
    goal_constraints: tuple[Constraints, ...] = ()
    max_velocity_scaling_factor: float = 0.0


class _PlanningOptions(_Message):
    plan_only: bool = False


class MoveRequest(_Message):
    """The goal of moveit_msgs/action/MoveGroup, as far as it is played."""

    request: _PlanRequest
    planning_options: _PlanningOptions = _PlanningOptions()


Asked = TrajectoryGoal | GripperGoal | MoveRequest


def asked_of(kind: str, goal: object) -> Asked:
    """Return the goal of an action of a type.

    Raises:
        MalformedMessageError: a field is not there, or is of another type.
    """
    try:
        if kind == FOLLOW_JOINT_TRAJECTORY:
            return _FollowJointTrajectory.model_validate(goal).goal()
        if kind == GRIPPER_COMMAND:
            return _GripperCommand.model_validate(goal).goal()
        if kind == PARALLEL_GRIPPER_COMMAND:
            return _ParallelGripperCommand.model_validate(goal).goal()
        return MoveRequest.model_validate(goal)
    except ValidationError as error:
        where = ".".join(str(part) for part in error.errors()[0]["loc"])
        raise MalformedMessageError(f"a goal of `{kind}` whose `{where}` cannot be read") from None


def result_of(kind: str, ended: TrajectoryEnded | GripperEnded) -> Mapping[str, object]:
    """Return the fields of the result of a goal that a controller ended."""
    if isinstance(ended, TrajectoryEnded):
        return {"error_code": ended.error_code, "error_string": ended.error_string}
    reached = {"stalled": ended.stalled, "reached_goal": ended.reached_goal}
    if kind == GRIPPER_COMMAND:
        return {**reached, "position": _first(ended.position), "effort": _first(ended.effort)}
    return {**reached, "state": {"position": list(ended.position), "effort": list(ended.effort)}}


def feedback_of(feedback: TrajectoryFeedback, joints: Sequence[str]) -> Mapping[str, object]:
    """Return the fields of the feedback of a trajectory."""

    def point(positions: Sequence[float]) -> dict[str, Any]:
        return {"positions": list(positions), "time_from_start": _time(feedback.time_from_start_ns)}

    return {
        "header": {"stamp": _time(feedback.sampled_ns)},
        "joint_names": list(joints),
        "desired": point(feedback.desired),
        "actual": point(feedback.actual),
        "error": point(feedback.error),
    }


def planned(trajectory: TimedTrajectory) -> Mapping[str, object]:
    """Return the fields of a moveit_msgs/RobotTrajectory."""
    points = [
        {
            "positions": list(point.positions),
            "velocities": list(point.velocities),
            "accelerations": list(point.accelerations),
            "time_from_start": _time(point.time_from_start_ns),
        }
        for point in trajectory.points
    ]
    return {"joint_trajectory": {"joint_names": list(trajectory.joints), "points": points}}


def _time(time_ns: int) -> dict[str, Any]:
    return {"sec": time_ns // _NANOSECONDS, "nanosec": time_ns % _NANOSECONDS}


def _first(values: Sequence[float]) -> float:
    return values[0] if values else 0.0
