"""Interfaces of the controller: which kinds it has, where they stand, and how values are read."""

from __future__ import annotations

import numpy as np

from cellc.mock.control.controllers.base import Context, claimed_names
from cellc.mock.control.controllers.joint_trajectory.spline import StartState
from cellc.mock.control.interfaces import Array, Columns


class JointInterfaces:
    """Columns of the joints' commands and states by kind.

    Args:
        context: the controller's context, with parameters declared.
    """

    def __init__(self, context: Context) -> None:
        parameters = context.parameters
        self._context = context
        self.joints = parameters.texts("joints")
        self.command_joints = parameters.texts("command_joints") or self.joints
        self.command_kinds = parameters.texts("command_interfaces")
        self.state_kinds = parameters.texts("state_interfaces")
        self.commands: dict[str, Columns] = {}
        self.states: dict[str, Columns] = {}
        limits = (context.description.joints.get(joint) for joint in self.joints)
        self.continuous = np.array([joint is not None and joint.type == "continuous" for joint in limits])
        self.wraps = bool(self.continuous.any())

    def command_names(self) -> tuple[str, ...]:
        """Command interfaces that are claimed."""
        return claimed_names(self.command_joints, self.command_kinds)

    def state_names(self) -> tuple[str, ...]:
        """State interfaces that are read."""
        return claimed_names(self.joints, self.state_kinds)

    def bind(self) -> None:
        """Look up the columns; all interfaces exist by now."""
        table = self._context.table
        for kind in self.command_kinds:
            self.commands[kind] = table.command_columns([f"{joint}/{kind}" for joint in self.command_joints])
        for kind in self.state_kinds:
            self.states[kind] = table.state_columns([f"{joint}/{kind}" for joint in self.joints])

    @property
    def uses_pid(self) -> bool:
        """Velocity or effort alone is commanded through a PID of each joint."""
        return self.command_kinds in (("velocity",), ("effort",))

    @property
    def checks_velocity(self) -> bool:
        """Velocity errors are known only with a velocity (or effort) command and a velocity state."""
        return "velocity" in self.states and ("velocity" in self.commands or "effort" in self.commands)

    @property
    def checks_acceleration(self) -> bool:
        """Acceleration errors are known only with both interfaces."""
        return "acceleration" in self.states and "acceleration" in self.commands

    def read_states(self, now_ns: int, state: Array | None = None) -> StartState:
        """The measured state, from values of all state interfaces: the present ones where none are given."""
        state = self._context.table.state if state is None else state
        velocity = state[self.states["velocity"]] if "velocity" in self.states else None
        acceleration = state[self.states["acceleration"]] if "acceleration" in self.states else None
        return StartState(now_ns, state[self.states["position"]], velocity, acceleration)

    def read_commands(self, measured: StartState) -> StartState | None:
        """The commanded state, None where a position command is missing; kinds that are only measured are measured."""
        command = self._context.table.command
        if "position" not in self.commands or len(self.command_joints) != len(self.joints):
            return None
        position = command[self.commands["position"]]
        if np.isnan(position).any():
            return None
        velocity, acceleration = measured.velocity, measured.acceleration
        if velocity is not None and "velocity" in self.commands:
            velocity = command[self.commands["velocity"]]
        if acceleration is not None and "acceleration" in self.commands:
            acceleration = command[self.commands["acceleration"]]
        if any(values is not None and np.isnan(values).any() for values in (velocity, acceleration)):
            return None
        return StartState(measured.time_ns, position, velocity, acceleration)

    def held_positions(self) -> list[float]:
        """Positions that joints keep which a partial trajectory does not name: commanded, else measured."""
        table = self._context.table
        held = table.state[self.states["position"]]
        if "position" in self.commands and len(self.command_joints) == len(self.joints):
            commanded = table.command[self.commands["position"]]
            held = np.where(np.isnan(commanded), held, commanded)
        return [float(value) for value in held]

    def difference(self, desired: Array, actual: Array) -> Array:
        """desired - actual, for continuous joints the shortest way round (±pi); any leading shape."""
        error = desired - actual
        if self.wraps:
            turned = np.fmod(np.fmod(error, 2.0 * np.pi) + 2.0 * np.pi, 2.0 * np.pi)
            turned = np.where(turned > np.pi, turned - 2.0 * np.pi, turned)
            error = np.where(self.continuous, turned, error)
        return error

    def unwrap(self, start: Array, first: Array) -> Array:
        """Move the start of continuous joints by full turns next to the first point."""
        if not self.wraps or not np.isfinite(first).all():
            return start
        return np.where(self.continuous, first - self.difference(first, start), start)
