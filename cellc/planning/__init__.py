"""The deterministic planner: inverse kinematics, collision-free paths, and jerk-limited trajectories."""

from cellc.planning.disabled import DisabledPair, DisabledReason, disabled_collisions
from cellc.planning.failure import FailureReason, IkFailure, LimitsError, ModelError, PlanFailure
from cellc.planning.inverse import IkSolution
from cellc.planning.limits import JointLimits, PlanningGroup
from cellc.planning.model import RobotModel
from cellc.planning.path import JointPath
from cellc.planning.planner import Planner
from cellc.planning.reach import beyond_reach
from cellc.planning.scene import CollisionScene
from cellc.planning.shapes import Box
from cellc.planning.timing import time_parameterize
from cellc.planning.trajectory import LimitUse, TimedTrajectory, TrajectoryPoint

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
    "ModelError",
    "PlanFailure",
    "Planner",
    "PlanningGroup",
    "RobotModel",
    "TimedTrajectory",
    "TrajectoryPoint",
    "beyond_reach",
    "disabled_collisions",
    "time_parameterize",
]
