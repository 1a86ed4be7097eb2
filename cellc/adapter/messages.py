"""What crosses the adapter boundary: stamped state, bounded commands, and refusals with their reason."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from cellc.adapter.phase import Phase


@dataclass(frozen=True, slots=True)
class DeviceState:
    """One reading of a device; values in the order of the model's joints.

    Attributes:
        stamp_ns: when it was measured, on the clock of the model, in nanoseconds.
        positions: in the units of the joints.
        velocities: per second.
        efforts: N m or N; empty where the device measures none.
        phase: where the device stands.
        fault: why it is stopped, in the vendor's words; empty while it is not.
    """

    stamp_ns: int
    positions: tuple[float, ...]
    velocities: tuple[float, ...]
    efforts: tuple[float, ...]
    phase: Phase
    fault: str = ""


@dataclass(frozen=True, slots=True)
class JointCommand:
    """Where the joints are to be one command period after the last command, or after standstill.

    Attributes:
        stamp_ns: when it was made, on the clock of the model.
        positions: in the order and units of the model's joints.
    """

    stamp_ns: int
    positions: tuple[float, ...]


class RefusalReason(str, Enum):
    """Why a command changes nothing."""

    NOT_ACTIVE = "not active"
    WRONG_SIZE = "wrong size"
    NOT_FINITE = "not finite"
    OUT_OF_RANGE = "out of range"
    TOO_FAST = "too fast"
    STALE = "stale"


@dataclass(frozen=True, slots=True)
class Refusal:
    """A command that was refused; the device goes on as if it had not been sent, its watchdog too."""

    reason: RefusalReason
    text: str
