"""What a contract holds, in the form in which faults ask for it."""

from __future__ import annotations

from cellc.contract.contract import Contract, ContractController


def controllers(contract: Contract) -> dict[str, ContractController]:
    """Return the controllers of all managers."""
    return {name: facts for manager in contract.managers.values() for name, facts in manager.controllers.items()}


def driven_joints(contract: Contract) -> dict[str, str]:
    """Return the controller that moves each joint after start-up, or the device whose adapter does."""
    driven = {
        joint: name
        for name, facts in controllers(contract).items()
        if facts.active and facts.action is not None
        for joint in facts.joints
    }
    return driven | {joint: device for device, facts in contract.adapters.items() for joint in facts.joints}


def device_of(contract: Contract, controller: str) -> str | None:
    """Return the device that a controller moves; what is commanded behind an adapter is the device itself."""
    facts = controllers(contract).get(controller)
    return controller if facts is None else facts.device


def first_joints(contract: Contract) -> dict[str, str]:
    """Return one joint of everything that takes goals: the first, which stands for the others."""
    firsts: dict[str, str] = {}
    for joint, controller in driven_joints(contract).items():
        firsts.setdefault(controller, joint)
    return {joint: controller for controller, joint in firsts.items()}


def components(contract: Contract) -> dict[str, str]:
    """Return the hardware component of every device that has one."""
    found = {name: device.hardware_component for name, device in contract.devices.items()}
    return {name: component for name, component in found.items() if component is not None}


def stoppable(contract: Contract) -> dict[str, str]:
    """Return what stops of every device that stops by itself: its hardware component, or the device on its adapter."""
    return components(contract) | {device: device for device in contract.adapters}


def joints_of_device(contract: Contract, device: str) -> tuple[str, ...]:
    """Return the joints that the controllers of a device or its adapter drive, sorted."""
    if device in contract.adapters:
        return tuple(sorted(contract.adapters[device].joints))
    facts = controllers(contract).values()
    return tuple(sorted({joint for each in facts if each.device == device for joint in each.joints}))


def image_topic(contract: Contract, device: str) -> str | None:
    """Return the topic of a camera; None for another device."""
    camera = contract.devices[device].camera if device in contract.devices else None
    return None if camera is None else camera.topic
