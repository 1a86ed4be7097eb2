"""A device by its name in the contract: its facts, its component, the manager that has it, and who commands it."""

from __future__ import annotations

from cellc.contract.contract import Contract
from cellc.contract.devices import ContractDevice
from cellc.contract.vocabulary import Moment, Need, Unmet
from cellc.mock.control import ControllerManager
from cellc.mock.engine.control_stack import ControlStack


class DeviceView:
    """Looks devices up; it changes nothing."""

    def __init__(self, contract: Contract, control: ControlStack) -> None:
        """Bind the devices of a contract, and what moves them."""
        self.contract = contract
        self.control = control

    def facts(self, device: str) -> ContractDevice:
        """Return what the contract says of a device."""
        return self.contract.devices[device]

    def component(self, device: str) -> str:
        """Return the hardware component of a device, or what stops of one behind an adapter: its own name."""
        return self.facts(device).hardware_component or device

    def is_there(self, device: str) -> bool:
        """Tell whether a manager has its component: it has none of a robot description that it refused."""
        return any(self.control.managers_of_component(self.component(device)))

    def manager(self, device: str) -> ControllerManager:
        """Return the manager that has the component of a device."""
        return next(self.control.managers_of_component(self.component(device)))

    def unmet(self, device: str, need: Need) -> Unmet | None:
        """Return what becomes of a claim of a device that lacks something; None where a claim needs it not."""
        claim = self.facts(device).effects.get(Moment.CLAIM)
        return None if claim is None else claim.needs.get(need)

    def has_program(self, device: str) -> bool:
        """Tell whether set points of a device pass through a program of its own."""
        return self.unmet(device, Need.PROGRAM_RUNNING) is Unmet.KEEPS_SET_POINTS

    def claims(self, device: str) -> dict[str, str]:
        """Return the joints of a device whose position a controller commands, with the controller."""
        joints = {
            joint
            for manager in self.contract.managers.values()
            for facts in manager.controllers.values()
            if facts.device == device
            for joint in facts.joints
        }
        return {
            interface.removesuffix("/position"): entry.name
            for entry in self.manager(device).list_controllers()
            for interface in entry.claimed_interfaces
            if interface.endswith("/position") and interface.removesuffix("/position") in joints
        }
