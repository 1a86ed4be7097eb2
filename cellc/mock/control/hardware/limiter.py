"""Enforcement of joint limits on commands, as joint_limits::JointSaturationLimiter per command interface.

As recorded of ros2_control. A position is limited around the previous command, not around
the measured position; the measured position alone decides when a joint is so far outside that the update fails.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from cellc.mock.control.errors import UpdateError
from cellc.mock.control.hardware.joint_motion import clamp, hold_last, rate_limit, step_bounds
from cellc.mock.control.interfaces import Block, InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.robot_description import JointLimits

# ros2_control, joint_limits_helpers: half a degree, the same figure for prismatic joints.
_OUT_OF_BOUNDS_TOLERANCE = 0.0087
_THROTTLE_NS = 1_000_000_000
_KINDS = ("position", "velocity", "effort", "acceleration")


@dataclass(slots=True)
class _LimitedJoint:
    """A joint with limits: columns of its commands and of its measured values."""

    name: str
    limits: JointLimits
    commands: dict[str, int]
    states: dict[str, int]
    previous: dict[str, float] = field(default_factory=dict)


class CommandLimiter:
    """Limits the commands of all joints.

    Args:
        limits: limits by joint.
        table: the interfaces.
        period_ns: period of the manager, which is the time that limits are scaled by.
        log: receives throttled warnings on limited commands.
    """

    def __init__(self, limits: Mapping[str, JointLimits], table: InterfaceTable, period_ns: int, log: Log) -> None:
        self._table = table
        self._period_s = period_ns / 1e9
        self._log = log
        self._joints: list[_LimitedJoint] = []
        self._by_column: dict[int, tuple[_LimitedJoint, str]] = {}
        for name, limit in limits.items():
            self._add(name, limit)

    def _add(self, name: str, limits: JointLimits) -> None:
        table = self._table
        commands = {k: table.command_column(f"{name}/{k}") for k in _KINDS if table.has_command(f"{name}/{k}")}
        states = {k: table.state_column(f"{name}/{k}") for k in _KINDS if table.has_state(f"{name}/{k}")}
        if not commands or limits == JointLimits():
            return
        joint = _LimitedJoint(name, limits, commands, states)
        self._joints.append(joint)
        self._by_column.update({column: (joint, kind) for kind, column in commands.items()})

    def reset(self, interfaces: Sequence[str]) -> None:
        """Forget the previous commands of the joints of these interfaces, as a mode switch does."""
        names = {interface.rsplit("/", 1)[0] for interface in interfaces}
        for joint in self._joints:
            if joint.name in names:
                joint.previous.clear()

    def limit(self, column: int, value: float) -> float:
        """Limit one command of one cycle.

        Args:
            column: column of the command interface.
            value: the wanted command.

        Returns:
            The limited command; for NaN the present one, so that it has no effect.

        Raises:
            UpdateError: the measured position is outside the limits by more than half a degree (0.0087 rad).
        """
        entry = self._by_column.get(column)
        if math.isnan(value):
            return float(self._table.command[column])
        if entry is None:
            return value
        joint, kind = entry
        self._check_measured(joint, self._measured(joint, "position"))
        if not joint.previous:
            joint.previous["position"] = self._measured(joint, "position")
        limited = self._limit_kind(joint, kind, value)
        if limited != value:
            self._tell(joint, kind, value, limited)
        joint.previous[kind] = limited
        return limited

    def _measured(self, joint: _LimitedJoint, kind: str) -> float:
        return float(self._table.state[joint.states[kind]]) if kind in joint.states else math.nan

    def _check_measured(self, joint: _LimitedJoint, position: float) -> None:
        lower, upper = joint.limits.lower, joint.limits.upper
        if position > upper + _OUT_OF_BOUNDS_TOLERANCE or position < lower - _OUT_OF_BOUNDS_TOLERANCE:
            text = (
                f"Joint position is out of bounds for the joint : '{joint.name}' actual position: {position:g} "
                f"limits: [{lower:g}, {upper:g}]. This could be due to a hardware failure (or) the physical limits of "
                "the joint being larger than the ones defined in the URDF. Please recheck the URDF and the hardware "
                "to verify the joint limits."
            )
            self._log.error("joint_limiter_interface", text)
            raise UpdateError(text)

    def _limit_kind(self, joint: _LimitedJoint, kind: str, value: float) -> float:
        limits = joint.limits
        if kind == "position":
            previous = joint.previous.get("position", value)
            return clamp(value, *step_bounds(previous, self._step(joint), limits.lower, limits.upper))
        if kind == "velocity":
            return clamp(value, *self._velocity_bounds(joint))
        if kind == "effort":
            return clamp(value, *self._effort_bounds(joint))
        return clamp(value, -limits.acceleration, limits.acceleration)

    def _step(self, joint: _LimitedJoint) -> float:
        limits = joint.limits
        speed = limits.velocity
        if math.isfinite(limits.acceleration):
            measured = self._measured(joint, "velocity")
            known = 0.0 if math.isnan(measured) else abs(measured)
            speed = min(speed, known + limits.acceleration * self._period_s)
        return speed * self._period_s

    def _velocity_bounds(self, joint: _LimitedJoint) -> tuple[float, float]:
        limits, position = joint.limits, self._measured(joint, "position")
        low, high = -limits.velocity, limits.velocity
        if limits.has_position and not math.isnan(position):
            low = max((limits.lower - position) / self._period_s, low)
            high = min((limits.upper - position) / self._period_s, high)
            if position > limits.upper or position < limits.lower:
                low = high = 0.0
        if math.isfinite(limits.acceleration) and "velocity" in joint.previous:
            change = limits.acceleration * self._period_s
            low = max(joint.previous["velocity"] - change, low)
            high = min(joint.previous["velocity"] + change, high)
        return (low, high) if low <= high else (high, low)

    def _effort_bounds(self, joint: _LimitedJoint) -> tuple[float, float]:
        limits = joint.limits
        position, velocity = self._measured(joint, "position"), self._measured(joint, "velocity")
        low, high = -limits.effort, limits.effort
        if (position <= limits.lower and velocity <= 0.0) or velocity < -limits.velocity:
            low = 0.0
        if (position >= limits.upper and velocity >= 0.0) or velocity > limits.velocity:
            high = 0.0
        return low, high

    def _tell(self, joint: _LimitedJoint, kind: str, value: float, limited: float) -> None:
        if not self._log.throttle("limits", _THROTTLE_NS):
            return
        actual = "".join(f", {k}: {self._measured(joint, k):.6f}" for k in joint.states)
        self._log.error(
            "controller_manager",
            "Command of at least one joint is out of limits (throttled log). "
            f"Joint: '{joint.name}', (actual: [Joint: '{joint.name}'{actual}], "
            f"command: [Joint: '{joint.name}', {kind}: {value:.6f}], "
            f"limited: [Joint: '{joint.name}', {kind}: {limited:.6f}]) with desired period : {self._period_s:.6f} sec.",
        )

    def limit_block(self, block: Block, columns: Sequence[int]) -> int:
        """Limit the position commands of a block in place.

        Args:
            block: commands of the block, not limited yet.
            columns: columns that controllers write.

        Returns:
            How many leading cycles are limited exactly; the cycle after them has to be done alone.
        """
        cycles = len(block)
        if self._none_limited(block, columns):
            return cycles
        for column in columns:
            entry = self._by_column.get(column)
            if entry is None:
                continue
            cycles = min(cycles, self._limit_column(block, column, *entry))
            if cycles == 0:
                return 0
        return cycles

    def _none_limited(self, block: Block, columns: Sequence[int]) -> bool:
        """Whether all commands of the block are inside their limits; only position limits are looked at together."""
        joints = [self._by_column[column] for column in columns if column in self._by_column]
        for joint, kind in joints:
            if kind != "position" or math.isfinite(joint.limits.acceleration) or "position" not in joint.previous:
                return False
        if not joints:
            return True
        limited = [column for column in columns if column in self._by_column]
        wanted = np.empty((len(block) + 1, len(joints)))
        wanted[0] = [joint.previous["position"] for joint, _ in joints]
        wanted[1:] = block.command[:, limited]
        step = np.array([joint.limits.velocity * self._period_s for joint, _ in joints])
        lower = np.array([joint.limits.lower for joint, _ in joints])
        upper = np.array([joint.limits.upper for joint, _ in joints])
        low = np.maximum(np.minimum(wanted[:-1] - step, upper), lower)
        high = np.minimum(np.maximum(wanted[:-1] + step, low), upper)
        return bool(((wanted[1:] >= low) & (wanted[1:] <= high)).all())

    def _limit_column(self, block: Block, column: int, joint: _LimitedJoint, kind: str) -> int:
        if kind != "position" or math.isfinite(joint.limits.acceleration) or "position" not in joint.previous:
            return 0
        limits, command = joint.limits, block.command
        values = np.ascontiguousarray(command[:, column])
        if math.isnan(values.min()):
            values = hold_last(values[:, None], self._table.command[column : column + 1])[:, 0]
            command[:, column] = values
            if math.isnan(values[0]):
                return 0
        step, previous = limits.velocity * self._period_s, joint.previous["position"]
        limited, first = rate_limit(values, previous, step, limits.lower, limits.upper)
        if first == len(values):
            return first
        # A cycle that may have to write a (throttled) log line is done alone.
        silent = int(np.searchsorted(block.times_ns, self._log.silent_until_ns("limits")))
        if silent <= first:
            return first
        command[:, column] = limited
        return silent

    def first_out_of_bounds(self, block: Block, columns: Sequence[int]) -> int:
        """Index of the first cycle in which a limited joint was measured too far outside its limits."""
        joints = [self._by_column[column][0] for column in columns if column in self._by_column]
        joints = [joint for joint in joints if "position" in joint.states]
        if not joints:
            return len(block)
        measured = block.state[:, [joint.states["position"] for joint in joints]]
        lower = np.array([joint.limits.lower - _OUT_OF_BOUNDS_TOLERANCE for joint in joints])
        upper = np.array([joint.limits.upper + _OUT_OF_BOUNDS_TOLERANCE for joint in joints])
        outside = np.logical_or.reduce((measured > upper) | (measured < lower), axis=1)
        first = int(outside.argmax())
        return first if outside[first] else len(block)

    def commit(self, block: Block, columns: Sequence[int]) -> None:
        """Adopt the last commands of a block as previous commands."""
        last = block.command[-1]
        for column in columns:
            entry = self._by_column.get(column)
            if entry is not None:
                entry[0].previous[entry[1]] = float(last[column])
