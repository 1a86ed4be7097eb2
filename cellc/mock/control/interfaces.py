"""Command and state interfaces in two arrays, and blocks of update cycles over them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from cellc.mock.control.journal import CommandJournal

Array: TypeAlias = NDArray[np.float64]
Times: TypeAlias = NDArray[np.int64]
Flags: TypeAlias = NDArray[np.bool_]
Columns: TypeAlias = NDArray[np.intp]


class InterfaceTable:
    """Values of all interfaces between two update cycles.

    Attributes:
        command: values of the command interfaces, NaN where nothing was commanded yet.
        state: values of the state interfaces.
        claims: name of the controller that owns a command interface.
        absent: state interfaces that are not exported now: their component is not configured.
        journal: recorded commands, for listeners.
    """

    def __init__(self) -> None:
        self.command: Array = np.empty(0)
        self.state: Array = np.empty(0)
        self.claims: dict[str, str] = {}
        self.absent: frozenset[str] = frozenset()
        self.journal = CommandJournal()
        self._command_columns: dict[str, int] = {}
        self._state_columns: dict[str, int] = {}
        self._types: dict[str, str] = {}

    def add_command(self, name: str, value: float = math.nan, data_type: str = "double") -> int:
        """Add a command interface, or find it where it exists, and return its column."""
        if name not in self._command_columns:
            self._command_columns[name] = len(self._command_columns)
            self.journal.interface_names.append(name)
            self.command = np.append(self.command, value)
        self._types[name] = data_type
        return self._command_columns[name]

    def add_state(self, name: str, value: float, data_type: str = "double") -> int:
        """Add a state interface, or find it where it exists, and return its column."""
        if name not in self._state_columns:
            self._state_columns[name] = len(self._state_columns)
            self.state = np.append(self.state, value)
        self._types[name] = data_type
        return self._state_columns[name]

    def has_command(self, name: str) -> bool:
        """Whether a command interface of this name was exported."""
        return name in self._command_columns

    def has_state(self, name: str) -> bool:
        """Whether a state interface of this name was exported."""
        return name in self._state_columns

    def command_column(self, name: str) -> int:
        """Column of a command interface."""
        return self._command_columns[name]

    def state_column(self, name: str) -> int:
        """Column of a state interface."""
        return self._state_columns[name]

    def command_columns(self, names: Sequence[str]) -> NDArray[np.intp]:
        """Columns of several command interfaces."""
        return np.array([self._command_columns[name] for name in names], dtype=np.intp)

    def state_columns(self, names: Sequence[str]) -> NDArray[np.intp]:
        """Columns of several state interfaces."""
        return np.array([self._state_columns[name] for name in names], dtype=np.intp)

    def command_names(self) -> tuple[str, ...]:
        """Names of all command interfaces, in the order in which they were added."""
        return tuple(self._command_columns)

    def state_names(self) -> tuple[str, ...]:
        """Names of all state interfaces, in the order in which they were added."""
        return tuple(self._state_columns)

    def exported_states(self) -> tuple[str, ...]:
        """Names of the state interfaces that are there now, in the order in which they were added."""
        return tuple(name for name in self._state_columns if name not in self.absent)

    def data_type(self, name: str) -> str:
        """The declared data type of an interface."""
        return self._types[name]


@dataclass(slots=True)
class Block:
    """Update cycles of a block; row i belongs to the cycle at `times_ns[i]`.

    Attributes:
        times_ns: times of the cycles, evenly spaced.
        period_ns: time between two cycles.
        command: command interfaces after the update of each cycle, shape (cycles, commands).
        state: state interfaces as read in each cycle, shape (cycles, states).
    """

    times_ns: Times
    period_ns: int
    command: Array
    state: Array

    def __len__(self) -> int:
        return len(self.times_ns)

    def cut(self, cycles: int) -> Block:
        """The first cycles of the block."""
        return Block(self.times_ns[:cycles], self.period_ns, self.command[:cycles], self.state[:cycles])
