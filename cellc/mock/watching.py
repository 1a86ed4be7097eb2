"""The watch of claims as ``config/bring_up.json`` has it: it hears what a robot says, and ends what may not go on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from cellc.contract.bring_up import Watch
from cellc.contract.contract import Contract
from cellc.contract.vocabulary import Need
from cellc.mock.control import ControlEvent, ControllerChanged, ControllerManager
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.simulation import Simulation


class ClaimWatches:
    """Latches that a robot no longer follows set points, until a person acknowledges.

    Attributes:
        given_up: controllers that lost their claim to a watch, with the reason, until they are active again.
    """

    def __init__(
        self, contract: Contract, watches: Sequence[Watch], control: ControlStack, simulation: Simulation
    ) -> None:
        """Bind the watches of a plan; a person has acknowledged them all."""
        self.given_up: dict[str, str] = {}
        self._contract = contract
        self._watches = watches
        self._control = control
        self._simulation = simulation
        self._latched: dict[str, str] = {}

    def hear(self, device: str, need: Need, why: str, noted: Callable[[], None]) -> None:
        """Act on a message that a need of a device does not hold, where a watch listens to what says so.

        Args:
            noted: called when the claims are given up: by then the cell knows.
        """
        for watch in self._watches:
            if watch.device == device and self._is_said(watch, need):
                self._latched.setdefault(device, why)
                self._simulation.at(self._due_ns(watch), partial(self._end, watch, noted))

    def acknowledge(self) -> None:
        """Let claims be made again."""
        self._latched.clear()

    def look(self, event: ControlEvent) -> None:
        """Note that a controller has its claim again, which is taken again before an acknowledgment."""
        if not isinstance(event, ControllerChanged) or event.state != "active":
            return
        self.given_up.pop(event.controller, None)
        for watch in self._watches:
            if watch.device in self._latched and event.controller in self._keys(watch):
                self._simulation.at(self._due_ns(watch), partial(self._end, watch, lambda: None))

    def _due_ns(self, watch: Watch) -> int:
        return self._simulation.now_ns + round(watch.within_s * 1e9)

    def _is_said(self, watch: Watch, need: Need) -> bool:
        """Tell whether a controller of the device publishes what the watch listens to."""
        proof = watch.while_hold.get(need)
        return proof is not None and any(
            facts.device == watch.device and proof.topic.startswith(f"{facts.full_name}/")
            for manager in self._contract.managers.values()
            for facts in manager.controllers.values()
        )

    def _end(self, watch: Watch, noted: Callable[[], None]) -> None:
        if watch.device not in self._latched:
            return
        manager = self._manager(watch)
        active = {entry.name for entry in manager.list_controllers() if entry.state == "active"}
        if claims := [key for key in self._keys(watch) if key in active]:
            manager.switch_controllers([], claims)
            self.given_up |= dict.fromkeys(claims, self._latched[watch.device])
        noted()
        self._control.changed.fire(self._simulation.now_ns)

    def _keys(self, watch: Watch) -> tuple[str, ...]:
        """Return the names that the contract has for the controllers of a watch."""
        entries = self._contract.managers[self._name(watch)].controllers
        keys = {one.full_name.rpartition("/")[2]: key for key, one in entries.items()}
        return tuple(keys.get(name, name) for name in watch.controllers)

    def _manager(self, watch: Watch) -> ControllerManager:
        return self._control.managers[self._name(watch)]

    def _name(self, watch: Watch) -> str:
        return next(
            name
            for name, entry in self._contract.managers.items()
            if f"{entry.namespace}/controller_manager" == watch.manager
        )
