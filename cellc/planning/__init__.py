"""The deterministic planner: inverse kinematics, collision-free paths, and jerk-limited trajectories.

Read in this order: ``problem`` holds what is taken and given; ``model`` and ``scene`` the robot and what it may touch;
``chain`` one group of it. On these stand ``inverse_kinematics``, ``rrt_connect`` and ``cartesian``, which ``planner``
joins; ``splines``, ``motion_law`` and ``trajectory`` give a path its times; ``pair_sampling`` and ``collision_matrix``
find the pairs of links that need no check; ``statics`` has what holds the robot still.
"""

from cellc.planning.collision_matrix import DisabledPair, DisabledReason, decided_collisions, disabled_collisions
from cellc.planning.inverse_kinematics import IkSolution
from cellc.planning.model import RobotModel
from cellc.planning.pair_sampling import beyond_reach
from cellc.planning.planner import Planner
from cellc.planning.problem import (
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
from cellc.planning.scene import Box, CollisionScene
from cellc.planning.statics import CarriedMass, holding_efforts
from cellc.planning.trajectory import LimitUse, TimedTrajectory, TrajectoryPoint, time_parameterize

__all__ = [
    "Box",
    "CarriedMass",
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
    "ModelError",
    "PlanFailure",
    "Planner",
    "PlanningGroup",
    "RobotModel",
    "TimedTrajectory",
    "TrajectoryPoint",
    "UnknownShapeError",
    "beyond_reach",
    "decided_collisions",
    "disabled_collisions",
    "holding_efforts",
    "time_parameterize",
]
