"""A device that is driven by its vendor's own library: what it states, what it gets, within which bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from typing import Protocol

from cellc.contract.frozen import dataclass


class Unit(str, Enum):
    """Unit of a joint's position; velocities are per second, efforts N m for radians and N for meters (REP-103)."""

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


class Phase(str, Enum):
    """Where a device is; the first three and the last are states of a managed node (REP-2002 names).

    None of them says that the device is safe: that is the business of the vendor's safety controller and of the cell.
    """

    UNCONFIGURED = "unconfigured"  # no connection
    INACTIVE = "inactive"  # connected: state is read, every command is refused
    ACTIVE = "active"  # takes commands, holds without them
    STOPPED = "stopped"  # held by the watchdog, a fault or the vendor's safety; a person acknowledges
    FINALIZED = "finalized"  # disconnected for good


@dataclass(frozen=True, slots=True)
class DeviceState:
    """One reading of a device; values in the order of the model's joints.

    Attributes:
        stamp_ns: when it was measured, on the clock of the model, in nanoseconds.
        positions: in the units of the joints.
        velocities: per second.
        efforts: N m or N; empty where the device measures none.
        phase: where the device is.
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


STEP_TOLERANCE = 1e-6
"""Share by which a step may exceed what the greatest speed allows: rounding of a stream that runs at that speed."""


def check_command(
    model: AdapterModel, command: JointCommand, *, phase: Phase, last: Sequence[float], now_ns: int
) -> Refusal | None:
    """Return why a command must be refused; None for one to follow.

    Args:
        phase: of the device.
        last: positions of the last command that was taken, or where the joints stand if there is no stream.
        now_ns: on the clock of the model.
    """
    if phase is not Phase.ACTIVE:
        return Refusal(RefusalReason.NOT_ACTIVE, f"`{model.device}` is {phase.value}")
    if len(command.positions) != len(model.joints):
        text = f"{len(command.positions)} positions for {len(model.joints)} joints"
        return Refusal(RefusalReason.WRONG_SIZE, text)
    age_s = (now_ns - command.stamp_ns) / 1e9
    if abs(age_s) > model.command_timeout_s:
        text = f"command is {age_s:.4f} s old, {model.command_timeout_s:.4f} s allowed"
        return Refusal(RefusalReason.STALE, text)
    for joint, position, before in zip(model.joints, command.positions, last, strict=True):
        refusal = _check_joint(joint, position, before, model.command_period_s)
        if refusal is not None:
            return refusal
    return None


def _check_joint(joint: JointModel, position: float, before: float, period_s: float) -> Refusal | None:
    unit = joint.unit.value
    if not math.isfinite(position):
        return Refusal(RefusalReason.NOT_FINITE, f"`{joint.name}` is sent to {position}")
    if not joint.lower <= position <= joint.upper:
        text = f"`{joint.name}` is sent to {position:.6g} {unit}, allowed {joint.lower:.6g} to {joint.upper:.6g} {unit}"
        return Refusal(RefusalReason.OUT_OF_RANGE, text)
    speed = abs(position - before) / period_s
    if speed > joint.velocity * (1.0 + STEP_TOLERANCE):
        text = f"`{joint.name}` is sent off at {speed:.6g} {unit}/s, {joint.velocity:.6g} {unit}/s allowed"
        return Refusal(RefusalReason.TOO_FAST, text)
    return None


class DeviceAdapter(Protocol):
    """One device behind its library; vendor structs stay on the far side.

    Calls return immediately and never wait for motion. One client commands at a time: the node that serves the
    device's action. An implementation passes `cellc.contract.adapter.conformance`.
    """

    @property
    def model(self) -> AdapterModel:
        """Joints, units, bounds, rates and watchdog; the same before and after connecting."""
        ...

    def now_ns(self) -> int:
        """Return the present time on the clock of the model, which stamps states and is asked of commands."""
        ...

    def connect(self) -> None:
        """Open the connection and read: unconfigured to inactive. Nothing may move, and no old command returns.

        Raises:
            ConnectionError: the device does not answer or is not the one of the model.
        """
        ...

    def activate(self) -> None:
        """Take commands from now on: inactive to active. The device holds where it is until the first one.

        Raises:
            RuntimeError: the device is not inactive: a stop has to be acknowledged first.
        """
        ...

    def deactivate(self) -> None:
        """Hold, and refuse commands from now on: active to inactive."""
        ...

    def acknowledge(self) -> None:
        """Leave a stop after a person has looked: stopped to inactive, if the vendor's safety allows.

        Raises:
            RuntimeError: the device is not stopped, or still has reason to be.
        """
        ...

    def disconnect(self) -> None:
        """Hold and close the connection for good: finalized."""
        ...

    def read(self) -> DeviceState:
        """Return the newest state, measured at its stamp; in every phase but unconfigured.

        Raises:
            ConnectionError: there is no connection.
        """
        ...

    def command(self, command: JointCommand) -> Refusal | None:
        """Go towards a command, or refuse it whole; the first one opens a stream that the watchdog guards.

        A stream that is silent for longer than `command_timeout_s` ends in a stop.
        """
        ...

    def hold(self) -> None:
        """End the stream: bring the set points to a standstill within `stop_time_s` and stay; the phase remains.

        What is measured is no set point: a joint behind a spring would sink by its droop with each hold.
        """
        ...
