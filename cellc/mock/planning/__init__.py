"""The deterministic planner: inverse kinematics, collision-free paths, and jerk-limited trajectories."""

from cellc.mock.planning.disabled import always_colliding_or_adjacent
from cellc.mock.planning.failure import FailureReason, IkFailure, LimitsError, ModelError, PlanFailure
from cellc.mock.planning.inverse import IkSolution
from cellc.mock.planning.limits import JointLimits, PlanningGroup
from cellc.mock.planning.model import RobotModel
from cellc.mock.planning.path import JointPath
from cellc.mock.planning.planner import Planner
from cellc.mock.planning.scene import Box, CollisionScene
from cellc.mock.planning.timing import time_parameterize
from cellc.mock.planning.trajectory import LimitUse, TimedTrajectory, TrajectoryPoint

__all__ = [
    "Box",
    "CollisionScene",
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
    "always_colliding_or_adjacent",
    "time_parameterize",
]
