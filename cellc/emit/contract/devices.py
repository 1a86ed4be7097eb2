"""Devices of the contract: what the mock needs of each, adapters with their bounds, joints that lag or have noise."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cellc.cell.cell import Cell
from cellc.cell.device import Device
from cellc.cell.interface import Interface, InterfaceKind
from cellc.contract.adapter import ContractAdapter
from cellc.contract.contract import ContractCamera, ContractDevice, ContractDriver, ContractGripper
from cellc.contract.simulated_joint import ContractSimulatedJoint
from cellc.formats.urdf.robot import start_positions
from cellc.graph.adapters import AdaptedDevice, adapted_devices
from cellc.link.placeholders import placeholders
from cellc.spec.devices import EVERY_JOINT, AdapterSpec, SimulatedJointSpec
from cellc.spec.quantity import Quantity


def devices(cell: Cell) -> dict[str, ContractDevice]:
    """Return every device by its name in the spec."""
    return {device.name: _device(cell, device) for device in cell.devices}


def _device(cell: Cell, device: Device) -> ContractDevice:
    return ContractDevice(
        model=device.facts.model,
        kind=device.facts.kind,
        prefix=device.prefix,
        root_link=device.root_link,
        architecture=device.spec.architecture,
        hardware_component=None if device.hardware is None or _adapted(cell, device) else device.hardware.name,
        driver=_driver(device),
        speed_scaling_interface=_speed_scaling(cell, device),
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


def _filled(cell: Cell, device: Device, text: str) -> str:
    return placeholders(device.name, device.prefix, device.spec, cell.spec).fill(text)


def _speed_scaling(cell: Cell, device: Device) -> str | None:
    scaling = device.facts.speed_scaling
    return None if scaling is None or _adapted(cell, device) else _filled(cell, device, scaling.state_interface)


def _gripper(cell: Cell, device: Device) -> ContractGripper | None:
    facts = device.facts.gripper
    if facts is None:
        return None
    controllers = (c.label for c in cell.controllers if c.device == device.name and c.action and c.active)
    return ContractGripper(
        joint=device.prefix + facts.joint,
        controller=next(controllers, None),
        open=facts.open.si,
        closed=facts.closed.si,
        max_effort=facts.max_force.si,
    )


def _camera(cell: Cell, device: Device) -> ContractCamera | None:
    """Return the stream that the spec uses, the catalogue's first where it names none."""
    facts = device.facts.camera
    if facts is None:
        return None
    streams = {_filled(cell, device, stream.topic): stream for stream in facts.streams.values()}
    used = _used_stream(cell, device, tuple(stream.type for stream in streams.values()))
    topic = next(iter(streams)) if used is None else used.name
    stream = streams.get(topic, next(iter(streams.values())))
    stamp = device.spec.stamp
    exposure = (None if stamp is None else stamp.exposure) or facts.exposure
    return ContractCamera(
        topic=topic,
        frame=(None if used is None else used.frame) or device.prefix + stream.frame,
        rate_hz=(None if used is None else used.rate_hz) or stream.rate.si,
        exposure_s=0.0 if exposure is None else exposure.si,
        clock="UNKNOWN" if stamp is None else stamp.clock,
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
"""Time to standstill of an adapter that states none."""


def adapters(cell: Cell) -> dict[str, ContractAdapter]:
    """Return every adapted device by its name."""
    start = start_positions(cell)
    return {adapted.device.name: _adapter(adapted, start) for adapted in adapted_devices(cell)}


def _adapter(adapted: AdaptedDevice, start: dict[str, float]) -> ContractAdapter:
    joints = adapted.device.actuated_joints
    written = adapted.device.spec.adapter or AdapterSpec()
    period_s = 1.0 / (adapted.state.rate_hz or DEFAULT_RATE_HZ)
    return ContractAdapter.model_validate(
        {
            "joints": tuple(joint.name for joint in joints),
            "units": tuple("m" if joint.type == "prismatic" else "rad" for joint in joints),
            "action": adapted.action.name,
            "state_topic": adapted.state.name,
            "client": next((sink.node for sink in adapted.action.sinks), None),
            "command_period_s": period_s,
            "command_timeout_s": _or(written.command_timeout, DEFAULT_TIMEOUT_PERIODS * period_s),
            "stop_time_s": _or(written.stop_time, DEFAULT_STOP_S),
            "start_positions": tuple(start.get(joint.name, 0.0) for joint in joints),
        }
    )


def _or(written: Quantity | None, default: float) -> float:
    return default if written is None else written.si


def simulated_joints(cell: Cell) -> dict[str, ContractSimulatedJoint]:
    """Return what the spec adds to joints, by joint; what it says of one joint counts before what it says of all."""
    found: dict[str, ContractSimulatedJoint] = {}
    for device in cell.devices:
        written = device.spec.simulated_joints
        for joint in device.actuated_joints:
            keys = (joint.name.removeprefix(device.prefix), EVERY_JOINT)
            if specs := [written[key] for key in keys if key in written]:
                found[joint.name] = _joint(specs)
    return found


def _joint(specs: Sequence[SimulatedJointSpec]) -> ContractSimulatedJoint:
    lag, noise = _first(spec.lag for spec in specs), _first(spec.noise for spec in specs)
    return ContractSimulatedJoint(
        lag_s=lag or 0.0, noise=noise or 0.0, max_velocity=_first(spec.velocity for spec in specs)
    )


def _first(written: Iterable[Quantity | None]) -> float | None:
    return next((value.si for value in written if value is not None), None)
