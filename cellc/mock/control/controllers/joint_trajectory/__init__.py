"""joint_trajectory_controller/JointTrajectoryController, also in its speed-scaled variants."""

from cellc.mock.control.controllers.joint_trajectory.controller import JointTrajectoryController

__all__ = ["JointTrajectoryController"]
