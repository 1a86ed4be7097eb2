"""Devices that digital outputs switch: which state each is in or on its way to, and what its sensors read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.devices import ContractSwitched


@dataclass(slots=True)
class _Way:
    """From a state to the next; ``arrives_ns`` is when it is there, ``read`` what a silent sensor shows for ever."""

    before: str
    state: str
    arrives_ns: int
    read: Mapping[str, bool] | None = None


class Switches:
    """The switched devices of a cell; one that is set again on its way turns back from where it was."""

    def __init__(self, contract: Contract) -> None:
        """Put every device into the state of its power-up."""
        switched = {name: device.switched for name, device in contract.devices.items()}
        self._facts: dict[str, ContractSwitched] = {
            name: facts for name, facts in switched.items() if facts is not None
        }
        self._ways = {name: _Way(facts.starts, facts.starts, 0) for name, facts in self._facts.items()}

    def set(self, device: str, state: str, now_ns: int) -> int:
        """Switch the outputs of a device for a state; return when it is there."""
        way = self._ways[device]
        if state == way.state:
            return max(now_ns, way.arrives_ns)
        way.before, way.state = self.state(device, now_ns), state
        way.arrives_ns = now_ns + round(self._facts[device].time_s * 1e9)
        return way.arrives_ns

    def state(self, device: str, now_ns: int) -> str:
        """Return the state that a device is in, or that it comes from while it is on its way."""
        way = self._ways[device]
        return way.state if now_ns >= way.arrives_ns else way.before

    def arrival_ns(self, device: str) -> int:
        """Return when a device is where it was last switched to."""
        return self._ways[device].arrives_ns

    def read(self, device: str, now_ns: int) -> Mapping[str, bool]:
        """Return what the sensors of a device read."""
        silent = self._ways[device].read
        return self._facts[device].states[self.state(device, now_ns)] if silent is None else silent

    def silence(self, device: str, now_ns: int) -> None:
        """Let the sensors of a device read for ever what they read now."""
        self._ways[device].read = self.read(device, now_ns)

    def restore(self, device: str) -> None:
        """Let the sensors of a device read again."""
        self._ways[device].read = None
