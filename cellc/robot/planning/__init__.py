"""The deterministic planner: inverse kinematics, collision-free paths, and jerk-limited trajectories.

Read in this order: ``problem`` holds what is taken and given; ``model`` and ``scene`` the robot and what it may touch;
``chain`` one group of it. On these stand ``inverse_kinematics``, ``rrt_connect`` and ``cartesian``, which ``planner``
joins; ``splines``, ``motion_law`` and ``trajectory`` give a path its times; ``pair_sampling`` and ``collision_matrix``
find the pairs of links that need no check; ``statics`` has what holds the robot still.
"""

from cellc.robot.planning.collision_matrix import (
    DisabledPair,
    DisabledReason,
    decided_collisions,
    disabled_collisions,
    standing_collisions,
)
from cellc.robot.planning.inverse_kinematics import IkSolution
from cellc.robot.planning.model import RobotModel
from cellc.robot.planning.pair_sampling import beyond_reach, meetings
from cellc.robot.planning.planner import Planner
from cellc.robot.planning.problem import (
    FailureReason,
    IkFailure,
    JointLimits,
    JointPath,
    LimitsError,
    ModelError,
    PlanFailure,
    PlanningGroup,
    UnknownShapeError,
)
from cellc.robot.planning.scene import Box, CollisionScene
from cellc.robot.planning.statics import Load, Springs, Weights, holding_efforts
from cellc.robot.planning.trajectory import LimitUse, TimedTrajectory, TrajectoryPoint, time_parameterize

__all__ = [
    "Box",
    "CollisionScene",
    "DisabledPair",
    "DisabledReason",
    "FailureReason",
    "IkFailure",
    "IkSolution",
    "JointLimits",
    "JointPath",
    "LimitUse",
    "LimitsError",
    "Load",
    "ModelError",
    "PlanFailure",
    "Planner",
    "PlanningGroup",
    "RobotModel",
    "Springs",
    "TimedTrajectory",
    "TrajectoryPoint",
    "UnknownShapeError",
    "Weights",
    "beyond_reach",
    "decided_collisions",
    "disabled_collisions",
    "holding_efforts",
    "meetings",
    "standing_collisions",
    "time_parameterize",
]
