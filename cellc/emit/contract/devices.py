"""Devices of the contract, as the mock needs them."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.device import Device
from cellc.cell.interface import Interface, InterfaceKind
from cellc.contract.contract import ContractCamera, ContractDevice, ContractDriver, ContractGripper
from cellc.graph.adapters import adapted_devices
from cellc.link.placeholders import placeholders


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
