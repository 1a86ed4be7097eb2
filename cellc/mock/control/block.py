"""A stretch of update cycles that is computed at once."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.control.interfaces import Array, Times


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
