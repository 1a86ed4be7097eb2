"""Who claimed which command interface, when, and whether the contract says so."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cellc.contract.contract import Contract
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Claim:
    """A controller owned a command interface from one instant to another."""

    interface: str
    controller: str
    from_ns: int
    until_ns: int
    by_contract: bool


@dataclass(frozen=True, slots=True)
class StateChange:
    """A controller or hardware component was in a state from an instant on; the reason is empty where it was asked."""

    stamp_ns: int
    kind: Literal["controller", "hardware component"]
    subject: str
    state: str
    reason: str


class ClaimBook:
    """Follows the owners of all command interfaces; looked at after every change of a controller."""

    def __init__(self, plant: Plant) -> None:
        """Bind the book to a plant."""
        self._plant = plant
        self._open: dict[str, tuple[str, int]] = {}
        self._closed: list[Claim] = []
        self._owners = _owners(plant.contract)

    def look(self, now_ns: int) -> None:
        """Note who owns what now."""
        present = {
            interface: controller.name
            for manager in self._plant.control.managers.values()
            for controller in manager.list_controllers()
            for interface in controller.claimed_interfaces
        }
        for interface, (owner, _) in list(self._open.items()):
            if present.get(interface) != owner:
                self._close(interface, now_ns)
        for interface, owner in present.items():
            self._open.setdefault(interface, (owner, now_ns))

    def claims(self, now_ns: int) -> tuple[Claim, ...]:
        """Close what is open and return everything, by interface and time."""
        for interface in list(self._open):
            self._close(interface, now_ns)
        return tuple(sorted(self._closed, key=lambda claim: (claim.interface, claim.from_ns)))

    def _close(self, interface: str, now_ns: int) -> None:
        owner, from_ns = self._open.pop(interface)
        by_contract = owner in self._owners.get(interface, ())
        self._closed.append(Claim(interface, owner, from_ns, now_ns, by_contract))


def _owners(contract: Contract) -> dict[str, set[str]]:
    """Return the controllers that may claim each interface: several where a switch is declared between them."""
    owners: dict[str, set[str]] = {}
    for manager in contract.managers.values():
        for name, controller in manager.controllers.items():
            for interface in controller.command_interfaces:
                owners.setdefault(interface, set()).add(name)
    return owners
