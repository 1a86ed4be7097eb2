"""The interfaces that mock_components/GenericSystem exports, with their initial values."""

from __future__ import annotations

import math

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.mock.control.interfaces import Array, InterfaceTable
from cellc.mock.control.robot_description import read_number
from cellc.robot.description.model import HardwareComponent, HardwareInterface

MOVING = ("position", "velocity", "acceleration")


@dataclass(frozen=True, slots=True)
class Exported:
    """What was exported.

    Attributes:
        commands: names of the command interfaces.
        states: names of the state interfaces.
        position, velocity, acceleration: initial values of the joints.
    """

    commands: list[str]
    states: list[str]
    position: Array
    velocity: Array
    acceleration: Array


def number_in(text: str, default: float) -> float:
    """Return what a text says, or a default where it is empty; raise ValueError for no number."""
    return read_number(text) if text else default


class Exporter:
    """Exports the interfaces of one component; those that exist already are left out.

    Args:
        info: the component.
        table: where they are exported to.
    """

    def __init__(self, info: HardwareComponent, table: InterfaceTable) -> None:
        self._info = info
        self._table = table
        self._commands: list[str] = []
        self._states: list[str] = []

    def export(self, offset: float, mock_sensors: bool, mock_gpios: bool) -> Exported:
        """Export everything.

        Args:
            offset: added to the initial positions of the joints.
            mock_sensors: whether sensors get a command interface for each state.
            mock_gpios: the same for gpios.

        Raises:
            ValueError: an initial value is no number.
        """
        joints = self._export_joints(offset)
        for parts, mocked in ((self._info.sensors, mock_sensors), (self._info.gpios, mock_gpios)):
            for part in parts:
                for command in part.state_interfaces if mocked else part.command_interfaces:
                    self._export_command(part.name, command, math.nan)
                for state in part.state_interfaces:
                    unset = math.nan if state.data_type in ("double", "float32") else 0.0
                    self._export_state(part.name, state, number_in(state.initial_value, unset))
        return Exported(self._commands, self._states, joints["position"], joints["velocity"], joints["acceleration"])

    def _export_joints(self, offset: float) -> dict[str, Array]:
        values: dict[str, list[float]] = {kind: [] for kind in MOVING}
        for part in self._info.joints:
            initial = {state.name: number_in(state.initial_value, 0.0) for state in part.state_interfaces}
            initial["position"] = initial.get("position", 0.0) + offset
            for kind in MOVING:
                values[kind].append(initial.get(kind, 0.0))
            for command in part.command_interfaces:
                self._export_command(part.name, command, number_in(command.initial_value, math.nan))
            for state in part.state_interfaces:
                self._export_state(part.name, state, initial[state.name])
        return {kind: np.array(column) for kind, column in values.items()}

    def _export_command(self, part: str, interface: HardwareInterface, value: float) -> None:
        name = f"{part}/{interface.name}"
        if not self._table.has_command(name):
            self._table.add_command(name, value, interface.data_type)
            self._commands.append(name)

    def _export_state(self, part: str, interface: HardwareInterface, value: float) -> None:
        name = f"{part}/{interface.name}"
        if not self._table.has_state(name):
            self._table.add_state(name, value, interface.data_type)
            self._states.append(name)
