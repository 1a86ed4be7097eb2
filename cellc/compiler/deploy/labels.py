"""Labels of the arrows in the cell's graph: interfaces, claims, drivers and the physical stop."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from itertools import groupby

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import TouchedFit
from cellc.compiler.cell.hardware import DeviceDriver
from cellc.compiler.cell.interface import Interface, Node
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.graph.claims import claimed_by_device
from cellc.compiler.graph.time_pairs import controllers_of, cycles_hz
from cellc.contract.vocabulary import PASSIVE, Behavior, InterfaceKind

TF_RATE_HZ = 20.0
"""Default of robot_state_publisher's ``publish_frequency``; the launch file states it."""

_TRANSFORMS = "tf2_msgs/msg/TFMessage"
# What a type says where the spec need not: TF names two frames in each transform, joints have none.
_FRAMES = {
    _TRANSFORMS: "in each transform",
    "sensor_msgs/msg/JointState": "joints",
    "control_msgs/action/FollowJointTrajectory": "joints",
    "control_msgs/action/GripperCommand": "joints",
    "control_msgs/action/ParallelGripperCommand": "joints",
    "std_msgs/msg/String": "none",
    "sensor_msgs/msg/Image": "header.frame_id",
    "sensor_msgs/msg/PointCloud2": "header.frame_id",
    "sensor_msgs/msg/CameraInfo": "header.frame_id",
}
_UNSTAMPED = ("std_msgs/msg/",)
_PLAIN_TEXT = "std_msgs/msg/String"
_PUBLISHED_ONCE = (_TRANSFORMS, _PLAIN_TEXT)
"""Types of what robot_state_publisher latches at its start: fixed transforms and the description."""
_NOT_STATED = "not stated"
# REP-103: SI and radians; by the joint's type.
_UNITS = {
    "position": ("rad", "m"),
    "velocity": ("rad/s", "m/s"),
    "acceleration": ("rad/s^2", "m/s^2"),
    "effort": ("Nm", "N"),
}

NO_DRIVER = "no driver in the catalog"


def interface_facts(interface: Interface, rates: Mapping[str, str]) -> Iterator[str]:
    """Yield type, frame, unit, rate, time source, owner and failure behavior; what is not stated says so.

    Args:
        rates: of the topics that controllers publish.
    """
    yield f"{interface.kind.value} {interface.type}, {rate_label(interface, rates)}"
    yield f"frame {frame_label(interface)}, unit {_unit(interface)}, time {_time(interface)}"
    yield f"owner {interface.owner or _NOT_STATED}; {failure_label(interface, rates)}"


def unused(cell: Cell) -> tuple[tuple[Interface, ...], ...]:
    """Return interfaces without a reader or client in the cell, grouped by server and owner."""
    interfaces: dict[tuple[object, ...], list[Interface]] = {}
    for interface in cell.interfaces:
        if interface.sources and not interface.sinks:
            offered_by = frozenset(end.full_name for end in interface.sources)
            interfaces.setdefault((offered_by, interface.kind, interface.owner), []).append(interface)
    return tuple(map(tuple, interfaces.values()))


def unused_title(group: tuple[Interface, ...]) -> str:
    """Return the title of interfaces without a user in the cell."""
    kind, use = group[0].kind, "reads" if group[0].kind is InterfaceKind.TOPIC else "calls"
    return f"{len(group)} {kind.value}{'s' if len(group) > 1 else ''} that no node of this cell {use}"


def unused_facts(group: tuple[Interface, ...]) -> Iterator[str]:
    """Yield the names of interfaces without a user, and their owner; the contract has the rest."""
    yield ", ".join(interface.name for interface in group)
    yield f"owner {group[0].owner or _NOT_STATED}"


def frame_label(interface: Interface) -> str:
    """Return the frame of an interface: the stated one, otherwise what its type says."""
    return interface.frame or _FRAMES.get(interface.type, _NOT_STATED)


def _unit(interface: Interface) -> str:
    return interface.unit or ("none" if interface.type == _PLAIN_TEXT else "per message type")


def _time(interface: Interface) -> str:
    return interface.time_source or ("none, unstamped" if interface.type.startswith(_UNSTAMPED) else _NOT_STATED)


_ON_CHANGE = "on change, latched"


def rates_of_controllers(cell: Cell) -> Mapping[str, str]:
    """Return how often controllers publish each of their topics.

    In each cycle, unless a parameter sets a rate; what the catalog states as latched is published as it changes.
    """
    rates: dict[str, str] = {}
    for manager, controller in controllers_of(cell):
        for topic in controller.own_topics:
            stated = topic.declared.qos
            is_latched = not isinstance(stated, str) and stated.durability == "transient_local"
            rate_hz = topic.rate_hz or cycles_hz(manager, controller)
            if topic.publishes:
                rates[topic.name] = _ON_CHANGE if is_latched else f"{shortest(rate_hz)} Hz"
    return rates


def rate_label(interface: Interface, rates: Mapping[str, str]) -> str:
    """Return how often an interface is used; ``rates`` are those of the topics that controllers publish."""
    if interface.rate_hz is not None:
        return f"{shortest(interface.rate_hz)} Hz"
    if interface.kind is not InterfaceKind.TOPIC:
        return "on request"
    if interface.name in rates:
        return rates[interface.name]
    if _latched(interface):
        return (
            "once, latched" if interface.derived and interface.type in _PUBLISHED_ONCE else "rate not stated, latched"
        )
    if interface.type == _TRANSFORMS:
        others = ", dynamic frames at their own rate" if len(interface.sources) > 1 else ""
        return f"{shortest(TF_RATE_HZ)} Hz{others}"
    return "rate not stated"


def _latched(interface: Interface) -> bool:
    return bool(interface.sources) and all(source.qos.durability == "transient_local" for source in interface.sources)


def failure_label(interface: Interface, rates: Mapping[str, str]) -> str:
    """Return what happens on each failure that the spec speaks of."""
    return ", ".join(_failures(interface, rates)) or "failure not stated"


def _failures(interface: Interface, rates: Mapping[str, str]) -> Iterator[str]:
    if interface.on_stale is not None:
        age = "" if interface.max_age_s is None else f" after {shortest(interface.max_age_s)} s"
        yield f"stale{age}: {interface.on_stale}"
    elif (
        interface.kind is InterfaceKind.TOPIC
        and rates.get(interface.name, _ON_CHANGE) == _ON_CHANGE
        and _latched(interface)
    ):
        yield "missing: readers wait"
    if interface.timeout_s is not None:
        yield f"timeout after {shortest(interface.timeout_s)} s: {interface.on_timeout or _NOT_STATED}"
    elif interface.kind is InterfaceKind.ACTION:
        yield "no timeout stated"
    if interface.goal_time_s is not None:
        yield f"ends at most {shortest(interface.goal_time_s)} s after its trajectory"
    if interface.cancel_within_s is not None:
        yield f"cancel holds within {shortest(interface.cancel_within_s)} s"
    if interface.on_error is not None:
        yield f"error: {interface.on_error}"


def claim_facts(
    cell: Cell, manager: ControllerManager, controller: Controller, claimed: Sequence[str], device: Device
) -> Iterator[str]:
    """Yield interfaces, frame, unit, rate, time source, owner, failure behavior and hardware of a claim.

    Args:
        claimed: what of the controller's claims is of the device.
    """
    rate = controller.update_rate_hz or manager.update_rate_hz
    yield "; ".join(_claims(controller, frozenset(claimed)))
    yield (
        f"frame joints, unit {units(cell, controller, claimed)}, {shortest(rate)} Hz, time of the update loop on "
        f"{manager.host or 'its host'}"
    )
    owner = cell.owners.responsibilities.command
    yield f"owner {owner}; on a violation: {controller.on_violation}; watchdog: {watchdog(device)}"
    state = "active from startup" if controller.active else "alternate, inactive at startup"
    driver, plugins = real_driver(device), {} if device.control.hardware is None else device.control.hardware.plugins
    on_mock = f"only on the mock, through {plugins.get('mock', 'no plugin')}"
    on_mock += f"; {NO_DRIVER}" if driver == NO_DRIVER else ""
    through = f"through {driver}" if "real" in controller.targets else on_mock
    yield f"{through}; {state}; architecture: {device.architecture}"


def _claims(controller: Controller, claimed: Container[str]) -> Iterator[str]:
    """Yield what is claimed, for each target by itself where they differ."""
    by_target = {
        target: ", ".join(folded(name for name in controller.claims(target) if name in claimed))
        for target in controller.targets
    }
    if len(set(by_target.values())) == 1:
        yield from dict.fromkeys(by_target.values())
    else:
        yield from (f"{claims} on {ON_TARGET[target]}" for target, claims in by_target.items())


ON_TARGET = {"mock": "the mock", "real": "real hardware"}
"""Names of the targets for people."""


def driver_facts(cell: Cell, device: Device, driver: DeviceDriver) -> Iterator[str]:
    """Yield program, goals, owner and watchdog of what moves a device past every controller on real hardware."""
    goals = ", ".join(action for action, _ in driver.actions.values()) or "none declared"
    yield f"{driver.program}, on real hardware; no controller claims anything there"
    yield f"goals: {goals}; frame joints, on request, time of the driver"
    watched = watched_stream(cell, device) or device.procedures.safety.watchdog or _NOT_STATED
    yield f"owner {cell.owners.responsibilities.vendor_safety}; watchdog: {watched}"
    yield f"architecture: {device.architecture}"


def helper_facts(device: Device, node: Node) -> Iterator[str]:
    """Yield program, services and owner of a node of a device's driver that no node of the cell talks to."""
    yield f"{node.package}/{node.executable}, on {'real hardware' if node.real_only else 'every target'}"
    services = [offer.name for offer in device.control.offers if offer.node == node.full_name]
    if services:
        yield f"services that no node of this cell calls: {', '.join(services)}"
    yield f"owner {node.owner}"


def watched_stream(cell: Cell, device: Device) -> str | None:
    """Return what an adapter does when commands stop arriving; None for a device without an adapter."""
    adapted = next((adapter for adapter in cell.adapters if adapter.device == device.name), None)
    if adapted is None:
        return None
    silence, stop = shortest(adapted.command_timeout_s), shortest(adapted.stop_time_s)
    return f"stops after {silence} s without commands, standstill within {stop} s"


def stop_facts(cell: Cell) -> Iterator[str]:
    """Yield path, independence and owner of the physical stop, which is no message."""
    stop, recovery = cell.safety.stop, cell.safety.recovery
    independent = ", ".join(stop.independent_of) or "nothing stated"
    yield f"path {stop.path}, independent of {independent}; no message, frame or clock"
    yield (
        f"owner {cell.owners.responsibilities.physical_stop}; recovery acknowledged by {recovery.acknowledge}, "
        f"owned by {recovery.owner}"
    )


def units(cell: Cell, controller: Controller, claimed: Sequence[str]) -> str:
    """Return the units of what a controller commands, each once; ``claimed`` are all or some of its claims."""
    joints = cell.joints_by_name
    names = (
        _UNITS[kind][joints[joint].type == "prismatic"]
        if joint in joints and kind in _UNITS
        else f"as {kind} of the device"
        for joint, _, kind in (name.rpartition("/") for name in claimed)
    )
    if controller.behavior in PASSIVE:
        return "per service type"
    return "per device" if controller.behavior is Behavior.OWN_MOTION else ", ".join(dict.fromkeys(names))


def folded(names: Iterable[str]) -> Iterator[str]:
    """Yield names with those that count up under one stem as one, such as ``output_[0..17]``."""
    for stem, numbered in groupby(names, key=lambda name: name.rstrip("0123456789")):
        counts = [name.removeprefix(stem) for name in numbered]
        if len(counts) > 1 and counts[0] and counts == [str(int(counts[0]) + step) for step in range(len(counts))]:
            yield f"{stem}[{counts[0]}..{counts[-1]}]"
        else:
            yield from (stem + count for count in counts)


def watchdog(device: Device) -> str:
    """Return the vendor's watchdog of a device, which stops it when commands stop arriving."""
    return device.procedures.safety.watchdog or _NOT_STATED


def watchdogs(cell: Cell, controller: Controller) -> str:
    """Return the watchdog of each device that a controller claims something of, by its name where there are several."""
    stated = {name: watchdog(cell.device(name)) for name in claimed_by_device(cell, controller)}
    if len(stated) < 2:
        return next(iter(stated.values()), _NOT_STATED)
    return "; ".join(f"{name}: {text}" for name, text in stated.items())


def real_driver(device: Device) -> str:
    """Return the plugin that moves a device on the real target, or the node with its program."""
    plugin = None if device.control.hardware is None else device.control.hardware.plugins.get("real")
    if plugin is not None:
        return plugin
    return (
        NO_DRIVER
        if device.control.driver is None
        else f"{device.control.driver.node} ({device.control.driver.program})"
    )


def said_around(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield each part of the surroundings that is stated, and what a person then finds there."""
    for part, known in cell.surroundings:
        if known.shapes:
            yield part, f"{', '.join(known.shapes)}, and nothing else within reach"
        if known.none is not None:
            yield part, f"nothing within reach; {known.none}"


def touched_label(fit: TouchedFit, is_plane: bool) -> str:
    """Return what a touched shape rests on: its points, how it was fitted, and by how far they miss it."""
    method = "least squares" if is_plane else "smallest box"
    mean, most = (f"{round(miss * 1e3, 3):g} mm" for miss in (fit.root_mean_square_m, fit.largest_m))
    return f"{fit.points} touched points, {method}: root mean square {mean}, largest {most}"
