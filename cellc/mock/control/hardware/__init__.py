"""Simulated hardware: mock_components/GenericSystem, its limits and its disturbances."""

from cellc.mock.control.hardware.disturbances import Disturbances
from cellc.mock.control.hardware.generic_system import GenericSystem
from cellc.mock.control.hardware.limiter import CommandLimiter

__all__ = ["CommandLimiter", "Disturbances", "GenericSystem"]
