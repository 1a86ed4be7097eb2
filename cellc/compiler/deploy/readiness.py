"""What a controller manager has when: its components, who claims, who reads what is there, and what shows late."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import WORLD, FrameKind
from cellc.compiler.cell.interface import Node
from cellc.compiler.cell.motion import PlanningGroup
from cellc.compiler.deploy.processes import asks_for_motion
from cellc.compiler.graph.claims import crosses_a_joint
from cellc.contract.entities import Target
from cellc.contract.vocabulary import PASSIVE, Behavior


def components_of(cell: Cell, manager: ControllerManager, target: Target) -> Iterator[Device]:
    """Yield the devices whose components a manager has on a target."""
    return (device for device in map(cell.device, manager.devices) if is_on(device, target))


def is_on(device: Device, target: Target) -> bool:
    """Whether a target has the component of a device."""
    return device.control.hardware is not None and target in device.control.hardware.targets


def activated_later(cell: Cell, manager: ControllerManager, target: Target) -> tuple[Device, ...]:
    """Return what does not start active: its activation moves something, or must be one call, or the spec says so."""
    return tuple(device for device in components_of(cell, manager, target) if device.control.startup_state != "active")


def started_active(manager: ControllerManager, target: Target) -> Iterator[Controller]:
    """Yield the controllers that the bring-up of a target activates."""
    return (controller for controller in manager.controllers if controller.active and target in controller.targets)


def is_claiming(cell: Cell, controller: Controller, later: tuple[Device, ...]) -> bool:
    """Whether a controller is activated with those that command joints, not before them.

    One that answers services is wanted before anybody claims: it says what mode the robot is in. It waits where its
    hardware starts later, or where it claims a joint itself, whatever its kind is called.
    """
    served_early = controller.behavior in PASSIVE and controller.device not in {device.name for device in later}
    moves = any(interface.rpartition("/")[0] in cell.joints_by_name for interface in controller.command_interfaces)
    return bool(controller.command_interfaces) and (moves or not served_early)


def readers_of(cell: Cell, manager: ControllerManager, target: Target) -> Iterator[Controller]:
    """Yield the controllers of a target that read states or answer services, and are active before any claim."""
    later = activated_later(cell, manager, target)
    return (reader for reader in started_active(manager, target) if not is_claiming(cell, reader, later))


def is_exported(cell: Cell, manager: ControllerManager, reader: Controller, target: Target) -> bool:
    """Whether an interface that a controller reads exists before a person activates hardware.

    A component exports its interfaces from its configuration on. Without one, joint_state_broadcaster ends its
    activation with an error, and the manager refuses any other controller.
    Source: https://github.com/ros-controls/ros2_controllers/blob/5.17.0/joint_state_broadcaster/src/joint_state_broadcaster.cpp
    """
    read = components_read(cell, manager, reader, target)
    return not read or any(device.control.startup_state != "unconfigured" for device in read)


def components_read(cell: Cell, manager: ControllerManager, reader: Controller, target: Target) -> tuple[Device, ...]:
    """Return the components that a controller reads; joint_state_broadcaster reads all, whatever its device is."""
    components = tuple(components_of(cell, manager, target))
    if reader.behavior is Behavior.JOINT_STATE_BROADCASTER or reader.device is None:
        named = {interface.rpartition("/")[0] for interface in reader.state_interfaces}
        return tuple(device for device in components if not named or named & {joint.name for joint in device.joints})
    return tuple(device for device in components if device.name == reader.device)


def measured_in(cell: Cell, node: Node) -> tuple[str, ...]:
    """Return the frames in which a node publishes others."""
    published = (frame for frame in cell.frames if frame.kind is FrameKind.DYNAMIC and frame.authority == node.name)
    return tuple(dict.fromkeys(frame.parent for frame in published))


def hardware_before(cell: Cell, node: Node, target: Target) -> tuple[str, ...]:
    """Return the devices that a person activates before a transform that a node needs is shown."""
    return tuple(
        device
        for device in _unconfigured(cell, target)
        if any(crosses_a_joint(cell, WORLD, parent, {device}) for parent in measured_in(cell, node))
    )


def shown_late(cell: Cell) -> Iterator[PlanningGroup]:
    """Yield the groups with joints whose states show only once hardware has been activated, on the real target."""
    devices = frozenset(_unconfigured(cell, "real"))
    return (group for group in cell.groups if crosses_a_joint(cell, group.base_link, group.tip_frame, devices))


def _unconfigured(cell: Cell, target: Target) -> tuple[str, ...]:
    """Return the names of the devices whose components start unconfigured, without their interfaces."""
    devices = (device for manager in cell.managers for device in components_of(cell, manager, target))
    return tuple(device.name for device in devices if device.control.startup_state == "unconfigured")


def silent_until_activation(cell: Cell) -> frozenset[str]:
    """Return the full names of controllers and managed nodes that run only once a person has activated hardware."""
    readers = (
        reader.full_name
        for manager in cell.managers
        for reader in readers_of(cell, manager, "real")
        if not is_exported(cell, manager, reader, "real")
    )
    nodes = (
        node.full_name
        for node in cell.nodes
        if node.lifecycle and not asks_for_motion(cell, node) and hardware_before(cell, node, "real")
    )
    return frozenset((*readers, *nodes))


def moved_with(cell: Cell, device: str | None) -> str:
    """Return the device that a person releases with another: the arm that carries it, or what all of it hangs on."""
    devices = {each.name: each for each in cell.devices}
    frames = {frame.name: frame for frame in cell.frames}
    holder = device or ""
    while holder in devices and devices[holder].kind != "arm":
        below = frames.get(devices[holder].mount.parent_frame)
        while below is not None and below.device is None:
            below = frames.get(below.parent)
        if below is None or below.device is None:
            break
        holder = below.device
    return holder
