"""Everything that a fault may hit, by the name that the user writes, with the name that the contract has for it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from cellc.cell.control import ControllerManager
from cellc.cell.device import Device
from cellc.cell.entity import Entity
from cellc.cell.interface import Interface, InterfaceKind
from cellc.link.frame_names import FrameNames
from cellc.spec.cell_spec import CellSpec

Names = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Target:
    """What one kind of fault may hit: a noun for messages, the code of an unknown one, and the names."""

    noun: str
    code: str
    names: Names


def fault_targets(
    spec: CellSpec,
    devices: tuple[Device, ...],
    managers: tuple[ControllerManager, ...],
    interfaces: tuple[Interface, ...],
    frames: FrameNames,
) -> Mapping[str, Target]:
    """Return what each kind of fault may hit; ``cancel`` and ``skip_cycles`` name nothing of the cell."""
    return {
        **_of_devices(devices),
        **_of_graph(managers, interfaces),
        "drop_frame": Target("frame", "unknown-frame", frames.by_reference),
        "double_frame": Target("frame", "unknown-frame", frames.by_reference),
        "jump_clock": Target("clock", "unknown-clock", _clocks(spec)),
        "unreachable": Target("goal", "unknown-goal", {name: name for name in spec.motion.goals}),
    }


def _of_devices(devices: tuple[Device, ...]) -> dict[str, Target]:
    """Return the faults that hit a device or one of its joints."""
    jointed = [device for device in devices if device.actuated_joints]
    seen = [device for device in devices if device.camera is not None or device in jointed]
    scaled = [device for device in jointed if device.speed_scaling is not None]
    arms = [device for device in jointed if device.kind == "arm"]
    code = "unknown-device"
    streams = Target("camera or device with joints", code, _named(seen))
    stoppable = Target("device with hardware", code, _named(jointed))
    joint = Target("joint", "unknown-joint", _joints(devices))
    return {
        **dict.fromkeys(("freeze", "delay", "cut_network"), streams),
        **dict.fromkeys(("stick", "slow", "displace"), joint),
        **dict.fromkeys(("protective_stop", "emergency_stop", "restart_driver"), stoppable),
        "scale_speed": Target("device with speed scaling", code, _named(scaled)),
        "wrong_payload": Target("arm", code, _named(arms)),
    }


def _of_graph(managers: tuple[ControllerManager, ...], interfaces: tuple[Interface, ...]) -> dict[str, Target]:
    """Return the faults that hit a controller, a switch, a server or an interface."""
    controllers = [controller for manager in managers for controller in manager.controllers]
    switches = [switch for manager in managers for switch in manager.switches]
    acting = _named(controller for controller in controllers if controller.action is not None)
    code = "unknown-controller"
    return {
        "mismatch_qos": Target("interface", "unknown-interface", _named(interfaces)),
        "unresponsive": Target("server", "unknown-node", {**_servers(interfaces), **acting}),
        "reject": Target("controller", code, _named(controllers)),
        "second_commander": Target("controller with an action", code, acting),
        "switch": Target("switch or controller", code, {**_named(controllers), **_named(switches)}),
    }


def _named(entities: Iterable[Entity]) -> dict[str, str]:
    return {entity.name: entity.name for entity in entities}


def _joints(devices: Iterable[Device]) -> dict[str, str]:
    return {f"{device.name}/{joint.local_name}": joint.name for device in devices for joint in device.joints}


def _servers(interfaces: Iterable[Interface]) -> dict[str, str]:
    """Return the nodes that serve an action or a service."""
    serving = (interface for interface in interfaces if interface.kind is not InterfaceKind.TOPIC)
    nodes = [source.node for interface in serving for source in interface.sources]
    return dict(zip(nodes, nodes, strict=True))


def _clocks(spec: CellSpec) -> dict[str, str]:
    """Return hosts, devices that state a clock, and the domains of both."""
    stamps = {name: device.stamp.clock for name, device in spec.devices.items() if device.stamp is not None}
    domains = {host.clock.domain for host in spec.hosts.values()} | set(stamps.values())
    names = ["ros", *spec.hosts, *stamps, *sorted(domains - {"UNKNOWN"})]
    return dict(zip(names, names, strict=True))
