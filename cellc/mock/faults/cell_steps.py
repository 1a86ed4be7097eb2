"""What a cell has that faults can hit: steps with what each rests on, controllers, joints, components and frames."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract, ContractController


@dataclass(frozen=True, slots=True)
class CellStep:
    """A step as it may stand in a rehearsal.

    Attributes:
        kind, target: as in rehearsals.json.
        controllers: those that get a goal in this step.
        observes: dynamic frame whose observation the step needs or rests on.
        frames: frames whose transforms it looks up.
    """

    kind: str
    target: str
    controllers: tuple[str, ...] = ()
    observes: str | None = None
    frames: tuple[str, ...] = ()


def cell_steps(contract: Contract) -> Iterator[CellStep]:
    """Yield every step that a rehearsal of the cell can take."""
    for name, poses in contract.poses.items():
        controllers = [contract.groups[pose.group].controller for pose in poses]
        yield CellStep("move", name, tuple(name for name in controllers if name is not None))
    for name, goal in contract.goals.items():
        controller = contract.groups[goal.group].controller
        yield CellStep(
            "move",
            name,
            () if controller is None else (controller,),
            _observed(contract, goal.frame),
            (*ancestors(contract, goal.frame), *ancestors(contract, contract.groups[goal.group].base_link)),
        )
    for name, frame in contract.frames.items():
        if frame.kind == "dynamic":
            yield CellStep("detect", name, observes=name)
    for name, device in contract.devices.items():
        if device.gripper is not None:
            yield CellStep("grip", name, () if device.gripper.controller is None else (device.gripper.controller,))
    yield CellStep("wait", "")


def ancestors(contract: Contract, frame: str) -> tuple[str, ...]:
    """Return a frame and all frames that it hangs from, up to the root."""
    chain: list[str] = []
    while frame in contract.frames and frame not in chain:
        chain.append(frame)
        frame = contract.frames[frame].parent
    return tuple(chain)


def _observed(contract: Contract, frame: str) -> str | None:
    dynamic = [name for name in ancestors(contract, frame) if contract.frames[name].kind == "dynamic"]
    return dynamic[0] if dynamic else None


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


def cameras(contract: Contract) -> dict[str, tuple[str, ...]]:
    """Return the dynamic frames that are seen in the images of each camera."""
    found: dict[str, tuple[str, ...]] = {}
    for name, device in contract.devices.items():
        if device.camera is not None and device.camera.topic in contract.interfaces:
            nodes = {sink.node for sink in contract.interfaces[device.camera.topic].sinks}
            frames = (frame for frame, facts in contract.frames.items() if facts.kind == "dynamic")
            found[name] = tuple(frame for frame in frames if contract.frames[frame].authority in nodes)
    return found


def published_frames(contract: Contract) -> tuple[str, ...]:
    """Return the frames on /tf that stand for all: the dynamic ones, and the first moving link of each group."""
    dynamic = [name for name, frame in contract.frames.items() if frame.kind == "dynamic"]
    chains = (ancestors(contract, group.tip_frame) for group in contract.groups.values())
    moving = [[name for name in chain if _moves(contract, name)] for chain in chains]
    return tuple(dict.fromkeys([*dynamic, *(names[-1] for names in moving if names)]))


def _moves(contract: Contract, frame: str) -> bool:
    return contract.frames[frame].kind == "link" and contract.frames[frame].moving
