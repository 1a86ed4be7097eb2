"""Devices of the contract: what the mock needs of each, adapters with their bounds, joints that lag or have noise."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import AdaptedDevice
from cellc.compiler.cell.device import CameraStream, Device, SimulatedJoint
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.hardware import Effect, HardwareComponent
from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.members import shared
from cellc.compiler.cell.stops import effect_of, stops_of
from cellc.compiler.cell.switched import Switched
from cellc.compiler.cell.vendor import SafetyState
from cellc.compiler.deploy.watches import heard
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.urdf.robot import start_positions
from cellc.compiler.graph.control_laws import control_laws
from cellc.contract.control_law import ControlLaw
from cellc.contract.devices import (
    ContractAdapter,
    ContractCamera,
    ContractDevice,
    ContractDriver,
    ContractEffect,
    ContractGripper,
    ContractImages,
    ContractSimulatedJoint,
    ContractStop,
    ContractSwitched,
)
from cellc.contract.vocabulary import UNKNOWN, InterfaceKind, Moment, Motion


def devices(cell: Cell) -> dict[str, ContractDevice]:
    """Return every device by its name in the spec."""
    laws = control_laws(cell)
    return {device.name: _device(cell, device, laws.get(device.name)) for device in cell.devices}


def _device(cell: Cell, device: Device, law: ControlLaw | None) -> ContractDevice:
    hardware = None if _adapted(cell, device) else device.control.hardware
    driver, switched = device.control.driver, device.switched
    special = {
        "hardware_component": None if hardware is None else hardware.name,
        "driver": None if driver is None else shared(driver, ContractDriver),
        "speed_scaling_interface": None if _adapted(cell, device) else device.control.speed_scaling,
        "gripper": contract_gripper(cell, device),
        "camera": _camera(cell, device),
        "switched": None if switched is None else _switched(switched),
        "law": law,
        "effects": _effects(hardware),
        "stops": _stops(device),
        "reports": {need: proof.topic for need, proof in heard(cell, device).items()},
        "nan_after_inactive": hardware is not None and hardware.direct_activation,
        "command_timeout_s": None if hardware is None else hardware.command_timeout_s,
    }
    return ContractDevice.model_validate({**shared(device, ContractDevice), **special})


_PLAYED = (
    Moment.ACTIVATE,
    Moment.CLAIM,
    Moment.PROGRAM_START,
    Moment.PROGRAM_STOP,
    Moment.PROGRAM_PAUSE,
    Moment.PROGRAM_RESUME,
    Moment.LINK_LOST,
    Moment.RECONNECT,
)
"""Moments that the mock plays; what a stop does is in the states that stop a device."""


def _effects(hardware: HardwareComponent | None) -> dict[Moment, ContractEffect]:
    """Return what the hardware does at the moments that the mock plays; a moment of nothing is left out."""
    by_moment = {} if hardware is None else hardware.effects
    effects = {
        moment: ContractEffect.model_validate(shared(by_moment[moment], ContractEffect))
        for moment in _PLAYED
        if moment in by_moment
    }
    return {moment: effect for moment, effect in effects.items() if effect != ContractEffect()}


def _stops(device: Device) -> dict[str, ContractStop]:
    """Return the states in which a device stops by itself."""
    return {state.name: _stop(state, effect_of(device, state)) for state in stops_of(device)}


def _stop(state: SafetyState, effect: Effect | None) -> ContractStop:
    """Return a stop; one without a stated effect takes the component to inactive, in the mock alone."""
    return ContractStop(
        motion=Motion.NONE if effect is None else effect.motion,
        leaves="inactive" if effect is None or effect.leaves is None else effect.leaves,
        ends=(*(() if effect is None else effect.ends), *state.ends),
        left_by=state.left_by,
    )


def _adapted(cell: Cell, device: Device) -> bool:
    """Tell whether an adapter drives a device, so that no controller manager ever loads its hardware."""
    return any(adapted.device == device.name for adapted in cell.adapters)


def contract_gripper(cell: Cell, device: Device) -> ContractGripper | None:
    """Return what a gripper adds; None of another device."""
    gripper = device.gripper
    if gripper is None:
        return None
    controllers = (c.label for c in cell.controllers if gripper.joint in c.joints and c.action and c.active)
    caps = cell.bringup.caps
    stated = gripper.max_force if gripper.grip_force is None else gripper.grip_force
    capped = stated if caps is None or caps.force is None else min(caps.force, stated)
    return ContractGripper(
        joint=gripper.joint,
        controller=next(controllers, None),
        open=gripper.open,
        closed=gripper.closed,
        max_effort=capped,
        max_velocity=None if gripper.max_velocity is None else rounded(gripper.max_velocity),
        goal_tolerance=gripper.goal_tolerance,
        stroke_m=gripper.stroke_m,
        swing=gripper.swing,
    )


def _camera(cell: Cell, device: Device) -> ContractCamera | None:
    """Return the stream that the spec uses, the catalog's first where it names none."""
    if device.sensing.camera is None:
        return None
    streams = {stream.topic: stream for stream in device.sensing.camera.streams}
    used = _used_stream(cell, device, tuple(stream.type for stream in streams.values()))
    topic = next(iter(streams)) if used is None else used.name
    stream = streams.get(topic, next(iter(streams.values())))
    return ContractCamera(
        topic=topic,
        frame=(None if used is None else used.frame) or stream.frame,
        rate_hz=(None if used is None else used.rate_hz) or stream.rate_hz,
        exposure_s=device.sensing.exposure_s,
        clock=UNKNOWN if device.sensing.stamp is None else device.sensing.stamp.clock.domain,
        images=tuple(_images(device.sensing.camera.streams)),
    )


def _images(streams: Iterable[CameraStream]) -> Iterator[ContractImages]:
    """Yield the streams whose images can be drawn: what they see, and how large they are, is known."""
    for stream in streams:
        if stream.pixels is None or stream.view is None or stream.encoding is None:
            continue
        yield ContractImages(
            topic=stream.topic,
            info_topic=stream.info_topic,
            frame=stream.frame,
            width=stream.pixels[0],
            height=stream.pixels[1],
            encoding=stream.encoding,
            horizontal=rounded(stream.view.horizontal),
            vertical=rounded(stream.view.vertical),
            nearest_m=stream.view.nearest_m,
            farthest_m=stream.view.farthest_m,
        )


def _switched(switched: Switched) -> ContractSwitched:
    states = {name: dict(state.sensors) for name, state in switched.states.items()}
    return ContractSwitched.model_validate({**shared(switched, ContractSwitched), "states": states})


def _used_stream(cell: Cell, device: Device, types: tuple[str, ...]) -> Interface | None:
    """Return the stream in which something is detected, the first where none is: the mock has one for each camera."""
    used = [
        interface
        for interface in cell.interfaces
        if interface.kind is InterfaceKind.TOPIC
        and interface.type in types
        and any(source.node == device.name for source in interface.sources)
    ]
    detecting = {frame.authority for frame in cell.frames if frame.kind is FrameKind.DYNAMIC}
    looked_at = (interface for interface in used if detecting & {sink.node for sink in interface.sinks})
    return next(looked_at, next(iter(used), None))


def adapters(cell: Cell) -> dict[str, ContractAdapter]:
    """Return every adapted device by its name."""
    start = start_positions(cell)
    return {adapted.device: _adapter(cell.device(adapted.device), adapted, start) for adapted in cell.adapters}


def _adapter(device: Device, adapted: AdaptedDevice, start: dict[str, float]) -> ContractAdapter:
    joints = device.actuated_joints
    units = tuple("m" if joint.slides else "rad" for joint in joints)
    positions = tuple(start.get(joint.name, 0.0) for joint in joints)
    return ContractAdapter.model_validate(
        {**shared(adapted, ContractAdapter), "units": units, "start_positions": positions}
    )


def simulated_joints(cell: Cell) -> dict[str, ContractSimulatedJoint]:
    """Return what the spec adds to joints, by joint; what it says of one joint counts before what it says of all."""
    joints: dict[str, ContractSimulatedJoint] = {}
    for device in cell.devices:
        for joint in device.actuated_joints:
            if stated := device.simulated(joint.name):
                joints[joint.name] = _simulated(stated)
    return joints


def _simulated(stated: Sequence[SimulatedJoint]) -> ContractSimulatedJoint:
    return ContractSimulatedJoint(
        lag_s=_first(joint.lag_s for joint in stated) or 0.0,
        noise=_first(None if joint.noise is None else joint.noise.value for joint in stated) or 0.0,
        max_velocity=_first(None if joint.velocity is None else joint.velocity.value for joint in stated),
    )


def _first(values: Iterable[float | None]) -> float | None:
    return next((value for value in values if value is not None), None)
