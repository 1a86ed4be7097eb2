"""Devices of the contract: what the mock needs of each, adapters with their bounds, joints that lag or have noise."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cellc.cell.cell import Cell
from cellc.cell.device import Adapter, Device, SimulatedJoint
from cellc.cell.interface import Interface, InterfaceKind
from cellc.cell.site import UNKNOWN
from cellc.contract.contract import (
    ContractAdapter,
    ContractCamera,
    ContractDevice,
    ContractDriver,
    ContractGripper,
    ContractSimulatedJoint,
)
from cellc.formats.urdf.robot import start_positions
from cellc.graph.claims import AdaptedDevice, adapted_devices


def devices(cell: Cell) -> dict[str, ContractDevice]:
    """Return every device by its name in the spec."""
    return {device.name: _device(cell, device) for device in cell.devices}


def _device(cell: Cell, device: Device) -> ContractDevice:
    return ContractDevice(
        model=device.model,
        kind=device.kind,
        prefix=device.prefix,
        root_link=device.root_link,
        architecture=device.architecture,
        hardware_component=None if device.hardware is None or _adapted(cell, device) else device.hardware.name,
        driver=_driver(device),
        speed_scaling_interface=None if _adapted(cell, device) else device.speed_scaling,
        gripper=_gripper(cell, device),
        camera=_camera(cell, device),
    )


def _adapted(cell: Cell, device: Device) -> bool:
    """Tell whether an adapter drives a device, so that no controller manager ever loads its hardware."""
    return any(adapted.device.name == device.name for adapted in adapted_devices(cell))


def _driver(device: Device) -> ContractDriver | None:
    driver = device.driver
    if driver is None:
        return None
    return ContractDriver(node=driver.node, program=driver.program, joint_states=driver.joint_states)


def _gripper(cell: Cell, device: Device) -> ContractGripper | None:
    gripper = device.gripper
    if gripper is None:
        return None
    controllers = (c.label for c in cell.controllers if c.device == device.name and c.action and c.active)
    return ContractGripper(
        joint=gripper.joint,
        controller=next(controllers, None),
        open=gripper.open,
        closed=gripper.closed,
        max_effort=gripper.max_force,
    )


def _camera(cell: Cell, device: Device) -> ContractCamera | None:
    """Return the stream that the spec uses, the catalogue's first where it names none."""
    if device.camera is None:
        return None
    streams = {stream.topic: stream for stream in device.camera.streams}
    used = _used_stream(cell, device, tuple(stream.type for stream in streams.values()))
    topic = next(iter(streams)) if used is None else used.name
    stream = streams.get(topic, next(iter(streams.values())))
    return ContractCamera(
        topic=topic,
        frame=(None if used is None else used.frame) or stream.frame,
        rate_hz=(None if used is None else used.rate_hz) or stream.rate_hz,
        exposure_s=device.camera.exposure_s,
        clock=UNKNOWN if device.stamp is None else device.stamp.clock.domain,
    )


def _used_stream(cell: Cell, device: Device, types: tuple[str, ...]) -> Interface | None:
    return next(
        (
            interface
            for interface in cell.interfaces
            if interface.kind is InterfaceKind.TOPIC
            and interface.type in types
            and any(source.node == device.name for source in interface.sources)
        ),
        None,
    )


DEFAULT_RATE_HZ = 100.0
"""Of a state topic without a rate; a rule asks for one."""
DEFAULT_TIMEOUT_PERIODS = 10.0
"""Watchdog of an adapter that states none, in command periods."""
DEFAULT_STOP_S = 0.1
DEFAULT_GOAL_TIME_S = 0.5
DEFAULT_PATH_TOLERANCE = 0.05
"""Time to standstill of an adapter that states none."""


def adapters(cell: Cell) -> dict[str, ContractAdapter]:
    """Return every adapted device by its name."""
    start = start_positions(cell)
    return {adapted.device.name: _adapter(adapted, start) for adapted in adapted_devices(cell)}


def _adapter(adapted: AdaptedDevice, start: dict[str, float]) -> ContractAdapter:
    joints = adapted.device.actuated_joints
    stated = adapted.device.adapter or Adapter()
    period_s = 1.0 / (adapted.state.rate_hz or DEFAULT_RATE_HZ)
    return ContractAdapter.model_validate(
        {
            "joints": tuple(joint.name for joint in joints),
            "units": tuple("m" if joint.type == "prismatic" else "rad" for joint in joints),
            "action": adapted.action.name,
            "state_topic": adapted.state.name,
            "client": next((sink.node for sink in adapted.action.sinks), None),
            "command_period_s": period_s,
            "command_timeout_s": _or(stated.command_timeout_s, DEFAULT_TIMEOUT_PERIODS * period_s),
            "stop_time_s": _or(stated.stop_time_s, DEFAULT_STOP_S),
            "goal_time_s": _or(stated.goal_time_s, DEFAULT_GOAL_TIME_S),
            "path_tolerance": _or(stated.path_tolerance, DEFAULT_PATH_TOLERANCE),
            "start_positions": tuple(start.get(joint.name, 0.0) for joint in joints),
        }
    )


def _or(stated: float | None, default: float) -> float:
    return default if stated is None else stated


def simulated_joints(cell: Cell) -> dict[str, ContractSimulatedJoint]:
    """Return what the spec adds to joints, by joint; what it says of one joint counts before what it says of all."""
    found: dict[str, ContractSimulatedJoint] = {}
    for device in cell.devices:
        for joint in device.actuated_joints:
            if stated := device.simulated(joint.name):
                found[joint.name] = _simulated(stated)
    return found


def _simulated(stated: Sequence[SimulatedJoint]) -> ContractSimulatedJoint:
    return ContractSimulatedJoint(
        lag_s=_first(one.lag_s for one in stated) or 0.0,
        noise=_first(None if one.noise is None else one.noise.value for one in stated) or 0.0,
        max_velocity=_first(None if one.velocity is None else one.velocity.value for one in stated),
    )


def _first(values: Iterable[float | None]) -> float | None:
    return next((value for value in values if value is not None), None)
