"""What observations are made of: the topics, controllers, frames and devices of a cell, as texts for commands."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import Frame, FrameKind
from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.cell.site import Host
from cellc.compiler.formats.numbers import shortest
from cellc.contract.vocabulary import TRAJECTORIES, InterfaceKind
from cellc.tools.diagnose.fields import FIELDS, NOT_STATED, Scope, Subject


def subjects(cell: Cell, scope: Scope) -> tuple[Subject, ...]:
    """Return what a scope represents in a cell, in its order."""
    rows = _ROWS[scope](cell)
    return tuple(dict(zip(FIELDS[scope], row, strict=True)) for row in rows)


Rows = list[tuple[str, ...]]


def _cell(cell: Cell) -> Rows:
    network, safety = cell.network, cell.safety
    publishers = dict.fromkeys(frame.authority for frame in cell.frames if frame.kind is FrameKind.DYNAMIC)
    return [
        (
            cell.name,
            str(network.domain_id),
            str(cell.versions.rmw).split(" ")[0],
            network.discovery,
            ", ".join(["robot_state_publisher", *publishers]),
            safety.stop.authority,
            safety.recovery.observer,
        )
    ]


def _topics(cell: Cell) -> Rows:
    return [_topic(interface) for interface in cell.interfaces if interface.kind is InterfaceKind.TOPIC]


def _topic(topic: Interface) -> tuple[str, ...]:
    ends = [_qos("from", end) for end in topic.sources] + [_qos("to", end) for end in topic.sinks]
    return (
        topic.name,
        topic.type,
        _list(end.node for end in topic.sources),
        "; ".join(ends) or NOT_STATED,
        NOT_STATED if topic.rate_hz is None else f"{shortest(topic.rate_hz)} Hz",
        NOT_STATED if topic.max_age_s is None else f"{shortest(topic.max_age_s)} s",
    )


def _qos(way: str, end: Endpoint) -> str:
    history = f"last {end.qos.depth}" if end.qos.history == "keep_last" else "all"
    return f"{way} {end.node} {end.qos.reliability}, {end.qos.durability}, {history}"


def _actions(cell: Cell) -> Rows:
    rows: Rows = [
        (interface.name, _list(end.node for end in interface.sources), _list(end.node for end in interface.sinks))
        for interface in cell.interfaces
        if interface.kind is InterfaceKind.ACTION
    ]
    known = {row[0] for row in rows}
    rows += [
        (controller.action, controller.name, controller.client or "none")
        for controller in cell.controllers
        if controller.action is not None and controller.action not in known
    ]
    return rows


def _controllers(cell: Cell) -> Rows:
    return [
        _controller(controller, manager)
        for manager in cell.managers
        for controller in manager.controllers
        if controller.joints
    ]


def _trajectories(cell: Cell) -> Rows:
    return [
        _controller(controller, manager)
        for manager in cell.managers
        for controller in manager.controllers
        if cell.behaviors.get(controller.plugin) in TRAJECTORIES
    ]


def _controller(controller: Controller, manager: ControllerManager) -> tuple[str, ...]:
    stated = sorted({figure.value for figure in (controller.path_tolerance or {}).values()})
    return (
        controller.name,
        f"{manager.namespace}/{controller.name}",
        _manager_node(manager),
        controller.plugin,
        _list(controller.joints),
        _list(controller.command_interfaces),
        _list(shortest(tolerance) for tolerance in stated) or NOT_STATED,
    )


def _managers(cell: Cell) -> Rows:
    hardware = {
        device.name: device.control.hardware.name for device in cell.devices if device.control.hardware is not None
    }
    return [
        (
            _manager_node(manager),
            manager.namespace,
            shortest(manager.update_rate_hz),
            _list(hardware[name] for name in manager.devices if name in hardware),
        )
        for manager in cell.managers
    ]


def _manager_node(manager: ControllerManager) -> str:
    return f"{manager.namespace}/controller_manager"


def _frames(cell: Cell) -> Rows:
    # Links inside a device are its description's business; what the cell places or publishes is what goes wrong.
    wanted = (FrameKind.DYNAMIC, FrameKind.FIXED, FrameKind.MOUNT)
    return [_frame(frame) for frame in cell.frames if frame.kind in wanted]


def _frame(frame: Frame) -> tuple[str, ...]:
    return (frame.name, frame.parent, frame.authority, frame.calibration or "none")


def _nodes(cell: Cell) -> Rows:
    return [(node.full_name,) for node in cell.nodes]


def _lifecycle_nodes(cell: Cell) -> Rows:
    return [(node.full_name,) for node in cell.nodes if node.lifecycle]


def _hosts(cell: Cell) -> Rows:
    return [_host(host) for host in cell.hosts.values()]


def _host(host: Host) -> tuple[str, ...]:
    cards = _list(f"{name} {card.address}" for name, card in host.nics.items())
    offset = host.clock.max_offset_s
    return (host.name, host.scheduling, cards, NOT_STATED if offset is None else f"{shortest(offset)} s")


def _groups(cell: Cell) -> Rows:
    return [(group.name, _list(group.joints), group.tip_frame) for group in cell.groups]


def _devices(cell: Cell) -> Rows:
    return [_device(cell, device) for device in cell.devices]


def _arms(cell: Cell) -> Rows:
    return [_device(cell, device) for device in cell.devices if device.kind == "arm"]


def _grippers(cell: Cell) -> Rows:
    return [_device(cell, device) for device in cell.devices if device.kind == "gripper"]


def _cameras(cell: Cell) -> Rows:
    return [
        (stream.topic, stream.frame, f"{shortest(stream.rate_hz)} Hz", *_device(cell, device))
        for device in cell.devices
        if device.sensing.camera is not None
        for stream in device.sensing.camera.streams
    ]


def _device(cell: Cell, device: Device) -> tuple[str, ...]:
    connection = device.site.connection
    address = NOT_STATED if connection is None else connection.address or connection.port or NOT_STATED
    mass, center = (cell.text(*device.path, "payload", key) for key in ("mass", "center_of_mass"))
    load = "" if device.robot.payload is None else f"{mass}, center of mass {center}"
    return (
        device.name,
        address,
        _list(device.procedures.safety.modes),
        _list(state.name for state in device.procedures.safety.states),
        device.software.versions.firmware,
        device.software.versions.driver,
        load or NOT_STATED,
    )


def _list(names: Iterable[str]) -> str:
    return ", ".join(names) or NOT_STATED


_ROWS: dict[Scope, Callable[[Cell], Rows]] = {
    "cell": _cell,
    "topic": _topics,
    "action": _actions,
    "controller": _controllers,
    "trajectory": _trajectories,
    "manager": _managers,
    "frame": _frames,
    "node": _nodes,
    "lifecycle_node": _lifecycle_nodes,
    "device": _devices,
    "arm": _arms,
    "gripper": _grippers,
    "camera": _cameras,
    "host": _hosts,
    "group": _groups,
}
