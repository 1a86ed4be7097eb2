"""Simulated hardware: mock_components/GenericSystem, its limits and its disturbances."""

from cellc.mock.control.hardware.disturbances import Disturbances
from cellc.mock.control.hardware.generic_system import GenericSystem
from cellc.mock.control.hardware.joint_fault import JointFault, JointFaults
from cellc.mock.control.hardware.joint_motion import Noise
from cellc.mock.control.hardware.limiter import CommandLimiter

__all__ = ["CommandLimiter", "Disturbances", "GenericSystem", "JointFault", "JointFaults", "Noise"]
