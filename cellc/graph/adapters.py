"""Devices that their vendor's library drives behind an adapter: which action takes their trajectories."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.device import Device
from cellc.cell.interface import Interface, InterfaceKind
from cellc.cell.motion import PlanningGroup

TRAJECTORY_ACTION = "control_msgs/action/FollowJointTrajectory"
JOINT_STATE = "sensor_msgs/msg/JointState"


@dataclass(frozen=True, slots=True)
class AdaptedDevice:
    """A device with the action that its adapter serves and the topic of its stamped state."""

    device: Device
    action: Interface
    state: Interface


def adapted_devices(cell: Cell) -> tuple[AdaptedDevice, ...]:
    """Return the direct-SDK devices that no controller drives and whose adapter takes trajectories."""
    driven = {joint for controller in cell.controllers for joint in controller.joints}
    found: list[AdaptedDevice] = []
    for device in cell.devices:
        joints = [joint.name for joint in device.actuated_joints]
        if device.architecture != "direct_sdk" or not joints or any(name in driven for name in joints):
            continue
        action = _of_source(cell, device, InterfaceKind.ACTION, TRAJECTORY_ACTION)
        state = _of_source(cell, device, InterfaceKind.TOPIC, JOINT_STATE)
        if action is not None and state is not None:
            found.append(AdaptedDevice(device, action, state))
    return tuple(found)


def adapter_of_group(cell: Cell, group: PlanningGroup) -> AdaptedDevice | None:
    """Return the adapted device that moves every joint of a group; None where there is none."""
    for adapted in adapted_devices(cell):
        if group.joints and set(group.joints) <= {joint.name for joint in adapted.device.actuated_joints}:
            return adapted
    return None


def _of_source(cell: Cell, device: Device, kind: InterfaceKind, message_type: str) -> Interface | None:
    for interface in cell.interfaces:
        if any(source.node == device.name for source in interface.sources) and (
            (interface.kind, interface.type) == (kind, message_type)
        ):
            return interface
    return None
