"""What an adapter states of its device before anything moves: joints with units and bounds, rates and watchdog."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Unit(str, Enum):
    """Unit of a joint's position; velocities are per second, efforts N m for radians and N for metres (REP-103)."""

    RADIAN = "rad"
    METRE = "m"


@dataclass(frozen=True, slots=True)
class JointModel:
    """A joint that can be commanded.

    Attributes:
        name: as in the robot description.
        lower: least position; -inf where there is no bound.
        upper: greatest position; inf where there is no bound.
        velocity: greatest speed of a command.
    """

    name: str
    unit: Unit
    lower: float
    upper: float
    velocity: float


@dataclass(frozen=True, slots=True)
class AdapterModel:
    """The contract of one device.

    Attributes:
        device: name of the device in the cell.
        joints: in the order of every state and command.
        clock: clock domain of the stamps.
        command_period_s: time from one command of a stream to the next.
        command_timeout_s: watchdog: a stream that is silent for longer ends in a stop.
        stop_time_s: longest time from a hold or a stop to standstill.
    """

    device: str
    joints: tuple[JointModel, ...]
    clock: str
    command_period_s: float
    command_timeout_s: float
    stop_time_s: float

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints in order."""
        return tuple(joint.name for joint in self.joints)
