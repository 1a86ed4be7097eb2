"""A device of a few states that digital outputs switch, or that sensors tell: a pneumatic gripper, a lamp, a door."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.frozen import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchedState:
    """What the outputs are set to for a state, and what the sensors that are wired read in it."""

    outputs: Mapping[str, bool]
    sensors: Mapping[str, bool]


@dataclass(frozen=True, slots=True, kw_only=True)
class Switched:
    """How a device is switched in this cell.

    Args:
        states: by name, as the catalog has them.
        signals: outputs that it needs.
        outputs: output → the full name of the command interface that drives it, for those that are wired.
        inputs: sensor → the full name of the state interface that reads it, for those that are wired.
        starts: the state at power-up.
        time_s: from its output to the end of its way.
        within_s: how long its client waits for the sensors.
        holds: the state in which it holds a part or a tool; None for a device that holds nothing.
        power_lost: holds, drops or UNKNOWN.
        accepted_by: who accepts that it drops what it holds; None without a person.
    """

    states: Mapping[str, SwitchedState]
    signals: tuple[str, ...]
    starts: str
    outputs: Mapping[str, str]
    inputs: Mapping[str, str]
    time_s: float
    within_s: float
    holds: str | None
    power_lost: str
    accepted_by: str | None

    @property
    def distinct_states(self) -> tuple[str, ...]:
        """The states that the sensors that are wired tell from every other one."""
        return tuple(name for name in self.states if self._is_distinct(name))

    def _is_distinct(self, state: str) -> bool:
        read = self.states[state].sensors
        others = (other.sensors for name, other in self.states.items() if name != state)
        return bool(read) and all(any(other.get(name) != value for name, value in read.items()) for other in others)
