"""The deterministic planner: inverse kinematics, collision-free paths, and jerk-limited trajectories."""

from cellc.kinematics.disabled import DisabledPair, DisabledReason, disabled_collisions
from cellc.kinematics.failure import FailureReason, IkFailure, LimitsError, ModelError, PlanFailure
from cellc.kinematics.inverse import IkSolution
from cellc.kinematics.limits import JointLimits, PlanningGroup
from cellc.kinematics.model import RobotModel
from cellc.kinematics.path import JointPath
from cellc.kinematics.planner import Planner
from cellc.kinematics.reach import beyond_reach
from cellc.kinematics.scene import CollisionScene
from cellc.kinematics.shapes import Box
from cellc.kinematics.timing import time_parameterize
from cellc.kinematics.trajectory import LimitUse, TimedTrajectory, TrajectoryPoint

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
