"""mock_components/GenericSystem: which interfaces it exports, and what it does in a cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from cellc.contract.control_law import ControlLaw
from cellc.mock.control.hardware.disturbances import Disturbances
from cellc.mock.control.hardware.exporter import Exporter, number_in
from cellc.mock.control.hardware.forces import Forces
from cellc.mock.control.hardware.joint_motion import Motion, differences, hold_last, integral
from cellc.mock.control.hardware.spring_joints import SpringJoints
from cellc.mock.control.interfaces import Array, InterfaceTable
from cellc.mock.control.robot_description import follows, read_flag
from cellc.robot.description.model import HardwareComponent, Joint, Mimic
from cellc.robot.planning import Springs

_MODES = ("position", "velocity", "acceleration")


class GenericSystem:
    """One hardware component.

    Args:
        info: the component's description.
        joints: joints of the URDF, for mimic.
        table: where the interfaces are exported to; those that exist already are left out.
        disturbances: faults.
        forces: what moves the joints; None where they are where they are led to.

    Raises:
        ValueError: a parameter or initial value that cannot be read, with the message.
    """

    def __init__(
        self,
        info: HardwareComponent,
        joints: Mapping[str, Joint],
        table: InterfaceTable,
        disturbances: Disturbances,
        forces: Forces | None = None,
    ) -> None:
        self.info = info
        self._forces = forces
        self._brakes = False
        self._table = table
        self._disturbances = disturbances
        self._first_cycle = self._read_cycles = 0
        self._springs: SpringJoints | None = None
        parameters = info.parameters
        self._dynamics = read_flag(parameters.get("calculate_dynamics", "false"))
        self.commands_disabled = read_flag(parameters.get("disable_commands", "false"))
        self._offset = number_in(parameters.get("position_state_following_offset", ""), 0.0)
        self._custom_offset = parameters.get("custom_interface_with_following_offset", "")
        mock_sensors = read_flag(parameters.get("mock_sensor_commands", "false"))
        mock_gpios = read_flag(parameters.get("mock_gpio_commands", "false"))
        exported = Exporter(info, table).export(0.0 if self._custom_offset else self._offset, mock_sensors, mock_gpios)
        self.command_names, self.state_names = exported.commands, exported.states
        self._position, self._velocity, self._acceleration = exported.position, exported.velocity, exported.acceleration
        self._motion: Motion | None = None
        self._names = [part.name for part in info.joints]
        self._modes = ["position"] * len(self._names)
        self._mimics = self._find_mimics(joints)
        self._command_columns = {kind: self._columns(kind, True) for kind in _MODES}
        self._moving_columns = {kind: self._in_mode(kind) for kind in _MODES}
        self._followed = np.concatenate([self._command_columns[kind][1] for kind in _MODES])
        self._state_columns = {kind: self._columns(kind, False) for kind in _MODES}
        self._pairs = self._mirrored()
        self._offset_pairs = self._offset_mirrored()
        if forces is not None:
            forces.begin(dict(zip(self._names, self._position.tolist(), strict=True)))

    # -- what follows what -------------------------------------------------------------------------------------------

    def _find_mimics(self, joints: Mapping[str, Joint]) -> list[tuple[int, int, Mimic]]:
        mimics = []
        for index, part in enumerate(self.info.joints):
            mimic = joints[part.name].mimic
            if mimic is not None and follows(part):
                mimics.append((index, self._names.index(mimic.joint), mimic))
        return mimics

    def _columns(self, kind: str, command: bool) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Indices of the joints that have an interface of this component, and its columns."""
        names = self.command_names if command else self.state_names
        indices = [i for i, name in enumerate(self._names) if f"{name}/{kind}" in names]
        labels = [f"{self._names[i]}/{kind}" for i in indices]
        columns = self._table.command_columns(labels) if command else self._table.state_columns(labels)
        return np.array(indices, dtype=np.intp), columns

    def _mirrored(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Interfaces whose state is the command of the same name, apart from the moving ones of joints."""
        moving = {f"{name}/{kind}" for name in self._names for kind in _MODES}
        names = [name for name in self.command_names if name in self.state_names and name not in moving]
        return self._table.command_columns(names), self._table.state_columns(names)

    def _offset_mirrored(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Custom states that show the position command with the offset added."""
        names = [
            name
            for name in self._names
            if f"{name}/{self._custom_offset}" in self.state_names and f"{name}/position" in self.command_names
        ]
        commands = self._table.command_columns([f"{name}/position" for name in names])
        return commands, self._table.state_columns([f"{name}/{self._custom_offset}" for name in names])

    # -- mode switch -------------------------------------------------------------------------------------------------

    def refuse_switch(self, start: Sequence[str]) -> list[str]:
        """Answer prepare_command_mode_switch.

        Args:
            start: command interfaces that are going to be claimed.

        Returns:
            The reasons for which the switch is refused, empty where it is accepted.
        """
        if not self._dynamics:
            return []
        requested: dict[str, int] = {}
        for key in start:
            # The real one searches the joint's name anywhere in the key, so `joint1` also finds `joint10`.
            joint = next((name for name in self._names if name in key), None)
            if joint is not None:
                requested[joint] = requested.get(joint, 0) + (key in {f"{joint}/{kind}" for kind in _MODES})
        reasons = []
        for joint, count in requested.items():
            if count == 0:
                reasons.append(f"Joint '{joint}' has to have 'position', 'velocity', or 'acceleration' interface!")
            elif count > 1:
                reasons.append(
                    f"Got multiple ({count}) starting interfaces for joint '{joint}' - this is not supported!"
                )
        return reasons

    def switch(self, start: Sequence[str]) -> None:
        """Carry out perform_command_mode_switch: the newly claimed kind of command moves the joint."""
        if not self._dynamics:
            return
        for key in start:
            joint, _, kind = key.rpartition("/")
            if joint in self._names and kind in _MODES:
                self._modes[self._names.index(joint)] = kind
        self._moving_columns = {kind: self._in_mode(kind) for kind in _MODES}

    def _in_mode(self, kind: str) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Indices of the joints that a kind of command moves now, and its columns."""
        indices, columns = self._command_columns[kind]
        if not self._dynamics:
            return indices, columns
        chosen = np.array([self._modes[index] == kind for index in indices], dtype=bool)
        return indices[chosen], columns[chosen]

    # -- cycles ------------------------------------------------------------------------------------------------------

    def lead(self, command: Array, period_ns: int) -> int:
        """Compute where the joints are led in successive cycles.

        Args:
            command: all command interfaces as they were before the read of each cycle, shape (cycles, commands).
            period_ns: time between two cycles.

        Returns:
            How many leading cycles were computed; a single cycle always is.
        """
        self._motion = None
        self._first_cycle = self._read_cycles
        if self.commands_disabled or self._disturbances.ignores_commands(self.info.name):
            if self._springs is not None:
                self._springs.rest(self._position)
            self._brake(len(command))
            return len(command)
        self._brakes = False
        if self._springs is not None:
            self._springs.clear()
        cycles = self._computable(command)
        if cycles == 0:
            return 0
        motion = Motion.standing(len(command), self._position, self._velocity, self._acceleration)
        self._move(motion, command, period_ns / 1e9)
        for child, parent, mimic in self._mimics:
            motion.position[:, child] = mimic.offset + mimic.multiplier * motion.position[:, parent]
            motion.velocity[:, child] = mimic.multiplier * motion.velocity[:, parent]
            motion.acceleration[:, child] = mimic.multiplier * motion.acceleration[:, parent]
        self._motion = motion
        if self._forces is not None:
            self._aim(self._forces, motion.position, command)
        return cycles

    def _aim(self, forces: Forces, positions: Array, command: Array) -> None:
        """Lead the joints that are commanded: one that another manager commands is led by that alone."""
        columns = [self._moving_columns[kind] for kind in _MODES]
        led = {
            int(i) for of, column in columns for i, at in zip(of, column, strict=True) if not np.isnan(command[0, at])
        }
        indices = sorted(led)
        forces.aim([self._names[index] for index in indices], positions[:, indices])

    def _brake(self, cycles: int) -> None:
        """Let drives that hear no command hold their joints where they were when that began."""
        if self._forces is None:
            return
        if not self._brakes:
            self._position, self._brakes = self._forces.standing(self._names), True
        self._forces.aim(self._names, Motion.standing(cycles, self._position, self._velocity, self._velocity).position)

    def show(self, command: Array, state: Array, period_ns: int) -> None:
        """Write the states of the cycles that `lead` computed.

        Args:
            command: as for `lead`.
            state: all state interfaces, shape (cycles, states), filled with the present ones; written in place.
            period_ns: time between two cycles.
        """
        motion = self._motion if self._forces is None else self._moved(self._forces, period_ns / 1e9)
        if motion is None:
            return
        for kind, values in (
            ("position", motion.position),
            ("velocity", motion.velocity),
            ("acceleration", motion.acceleration),
        ):
            indices, columns = self._state_columns[kind]
            if len(indices):
                state[:, columns] = values[:, indices]
        self._measure(state)
        if self._motion is not None:
            self._mirror(command, state)

    def _moved(self, forces: Forces, period_s: float) -> Motion:
        """Return how the joints really move."""
        velocity = forces.velocities(self._names)
        acceleration = differences(velocity, velocity[0], period_s)
        return Motion(forces.positions(self._names), velocity, acceleration)

    def _measure(self, state: Array) -> None:
        """Change what is measured of the joints; where they really are stays as it is."""
        if not self._disturbances.joints:
            return
        for index, column in zip(*self._state_columns["position"], strict=True):
            fault = self._disturbances.joints.of(self._names[index])
            if fault is not None:
                state[:, column] = fault.measured(state[:, column], self._first_cycle)

    def _computable(self, command: Array) -> int:
        """All cycles, or none where they depend on each other in a way that only single cycles can follow."""
        if len(command) == 1:
            return 1
        faults = self._disturbances.joints
        if faults and any(
            mode != "position" and faults.of(name) is not None
            for name, mode in zip(self._names, self._modes, strict=True)
        ):
            return 0
        # A column is all numbers or all NaN; a command that turns to or from NaN, or is infinite, is neither.
        suspicious = self._followed[~np.isfinite(command.sum(axis=0)[self._followed])]
        return 0 if suspicious.size and not np.isnan(command[:, suspicious]).all() else len(command)

    def _move(self, motion: Motion, command: Array, period_s: float) -> None:
        for kind in _MODES:
            indices, columns = self._moving_columns[kind]
            if not len(indices):
                continue
            given = ~np.isnan(command[0, columns])
            if not given.all():
                indices, columns = indices[given], columns[given]
            if len(indices):
                self._move_kind(motion, kind, indices, command[:, columns], period_s)

    def _move_kind(self, motion: Motion, kind: str, indices: NDArray[np.intp], values: Array, period_s: float) -> None:
        if kind == "position":
            position = values if self._custom_offset else values + self._offset
            if self._springs is not None:
                position = position.copy() if position is values else position
                self._springs.follow(indices, position, self._first_cycle, period_s)
            self._follow(indices, position, period_s, moved_by_position=True)
            motion.position[:, indices] = position
            if self._dynamics:
                velocity = differences(position, self._position[indices], period_s)
                motion.velocity[:, indices] = velocity
                if len(self._state_columns["acceleration"][0]):
                    motion.acceleration[:, indices] = differences(velocity, self._velocity[indices], period_s)
            return
        if not self._dynamics:
            (motion.velocity if kind == "velocity" else motion.acceleration)[:, indices] = values
            return
        if kind == "velocity":
            velocity = values
            motion.acceleration[:, indices] = differences(values, self._velocity[indices], period_s)
        else:
            velocity = integral(values, self._velocity[indices], period_s)
            motion.acceleration[:, indices] = values
        motion.velocity[:, indices] = velocity
        position = integral(velocity, self._position[indices], period_s)
        self._follow(indices, position, period_s, moved_by_position=False)
        motion.position[:, indices] = position

    def _follow(self, indices: NDArray[np.intp], position: Array, period_s: float, *, moved_by_position: bool) -> None:
        """Apply the faults of the joints in place."""
        if not self._disturbances.joints:
            return
        for column, index in enumerate(indices):
            fault = self._disturbances.joints.of(self._names[index])
            if fault is not None:
                fault = fault if moved_by_position else fault.integrated
                position[:, column] = fault.follow(
                    np.ascontiguousarray(position[:, column]), float(self._position[index]), period_s
                )

    def _mirror(self, command: Array, state: Array) -> None:
        columns, targets = self._pairs
        if len(columns):
            state[:, targets] = hold_last(command[:, columns], state[0, targets])
        columns, targets = self._offset_pairs
        if len(columns):
            state[:, targets] = hold_last(command[:, columns] + self._offset, state[0, targets])

    def bind(self, law: ControlLaw, springs: Springs) -> None:
        """Let the joints follow by a law from where they are; a law that binds them already gets another load.

        Drives of joints that have mass know their law.
        """
        if self._forces is not None:
            return
        if self._springs is None:
            self._springs = SpringJoints(law, springs, self._names, self._position)
        else:
            self._springs.load(springs)

    def place(self, joint: str, position: float) -> None:
        """Move a joint from outside."""
        index = self._names.index(joint)
        self._position[index] = position
        if self._springs is not None:
            self._springs.rest(self._position)
        if self._forces is not None:
            self._forces.place(joint, position)
        self._table.state[self._table.state_column(f"{joint}/position")] = position

    def rest(self) -> None:
        """Let every joint stand still where it is."""
        self._velocity[:] = self._acceleration[:] = 0.0
        for kind in ("velocity", "acceleration"):
            self._table.state[self._state_columns[kind][1]] = 0.0

    def commit(self, cycles: int) -> None:
        """Adopt the joints' values after the first cycles of what `read` computed last."""
        self._read_cycles = self._first_cycle + cycles
        motion = self._motion
        if motion is None:
            return
        if self._springs is not None:
            self._springs.commit(cycles)
        self._position = motion.position[cycles - 1].copy()
        self._velocity = motion.velocity[cycles - 1].copy()
        self._acceleration = motion.acceleration[cycles - 1].copy()
