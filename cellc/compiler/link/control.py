"""Binds controller managers with their hosts, hardware and switches, and devices that an adapter drives instead."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import AdaptedDevice, Controller, ControllerManager, ControllerSwitch
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import Adapter, DeviceDriver, Effect
from cellc.compiler.cell.interface import Endpoint, Interface, Node, ParameterValue
from cellc.compiler.link.controller import ControlContext, ControllerPlace, link_controller
from cellc.compiler.link.derived import JOINT_STATE_TYPE
from cellc.compiler.link.hopeless import until_hopeless
from cellc.compiler.link.names import home_host, unknown_name
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.control import ManagerSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, YamlPath
from cellc.contract.vocabulary import Behavior, CommandAuthority, InterfaceKind, ManagerLock, Motion


def link_managers(context: ControlContext) -> Outcome[tuple[ControllerManager, ...]]:
    """Bind every controller manager of the spec."""
    managers: list[ControllerManager] = []
    problems: list[Diagnostic] = []
    written_managers = _written_managers(context.spec)
    named = Counter(name for _, _, manager in written_managers for name in manager.controllers)
    shared = frozenset(name for name, count in named.items() if count > 1)
    for name, path, manager in written_managers:
        bound = _manager(name, path, manager, shared, context)
        problems += bound.diagnostics
        if bound.value is not None:
            managers.append(bound.value)
    return Outcome(tuple(managers), tuple(problems))


def _written_managers(spec: CellSpec) -> tuple[tuple[str, YamlPath, ManagerSpec], ...]:
    single: tuple[tuple[str, YamlPath, ManagerSpec], ...] = ()
    if spec.control is not None:
        single = (("control", ("control",), spec.control),)
    return single + tuple((name, ("managers", name), manager) for name, manager in spec.managers.items())


def _manager(
    name: str, path: YamlPath, written: ManagerSpec, shared: frozenset[str], context: ControlContext
) -> Outcome[ControllerManager]:
    controllers: list[Controller] = []
    problems: list[Diagnostic] = []
    document = context.document
    if written.host is not None and written.host not in context.spec.hosts:
        at = (*path, "host")
        problems.append(unknown_name("unknown-host", written.host, "host", context.spec.hosts, document, at))
    for key, entry in until_hopeless(written.controllers.items(), problems):
        label = f"{written.namespace}/{key}" if key in shared else key
        place = ControllerPlace(key, label, name, written.namespace, (*path, "controllers", key))
        bound = link_controller(place, entry, context)
        problems += bound.diagnostics
        if bound.value is not None:
            controllers.append(bound.value)
    problems += _unknown_switch_members(path, written, document)
    manager = ControllerManager(
        name=name,
        path=path,
        span=document.locate(path),
        namespace=written.namespace,
        update_rate_hz=written.update_rate.si,
        host=written.host or home_host(context.spec),
        devices=_managed_devices(written, context),
        controllers=tuple(controllers),
        switches=tuple(
            ControllerSwitch(
                name=key,
                path=(*path, "switches", key),
                span=document.locate((*path, "switches", key)),
                activate=entry.activate,
                deactivate=entry.deactivate,
            )
            for key, entry in written.switches.items()
        ),
    )
    return Outcome(manager, tuple(problems))


def _managed_devices(written: ManagerSpec, context: ControlContext) -> tuple[str, ...]:
    """One manager loads all hardware of the cell; several load what their own controllers drive."""
    with_hardware = tuple(name for name, bound in context.devices.items() if bound.device.control.hardware is not None)
    if not context.spec.managers:
        return with_hardware
    named = {entry.device for entry in written.controllers.values()}
    return tuple(name for name in with_hardware if name in named)


def _unknown_switch_members(path: YamlPath, written: ManagerSpec, document: SourceDocument) -> list[Diagnostic]:
    return [
        unknown_name(
            "unknown-controller", name, "controller", written.controllers, document, (*path, "switches", key, side, at)
        )
        for key, entry in written.switches.items()
        for side, names in (("activate", entry.activate), ("deactivate", entry.deactivate))
        for at, name in enumerate(names)
        if name not in written.controllers
    ]


TRAJECTORY_ACTION = "control_msgs/action/FollowJointTrajectory"

DEFAULT_RATE_HZ = 100.0
"""Of a state topic without a rate; a rule asks for one."""
DEFAULT_TIMEOUT_PERIODS = 10.0
"""Watchdog of an adapter that states none, in command periods."""
DEFAULT_STOP_S = 0.1
"""Time to standstill of an adapter that states none."""
DEFAULT_GOAL_TIME_S = 0.5
"""Time past the end of a trajectory within which the joints stand still, where the adapter states none."""
DEFAULT_PATH_TOLERANCE = 0.05
"""rad or m by which a joint may be away from its command, where the adapter states nothing."""


_CONNECTS = Effect(
    motion=Motion.NONE,
    authority=CommandAuthority.UNCHANGED,
    lock=ManagerLock.NONE,
    needs={},
    drops_part=False,
    leaves=None,
    does="connects and reads as it is configured; nothing moves, and no command is taken before the claim activates it",
)
"""What an adapter does as it starts: `DeviceAdapter.connect`, which its conformance holds."""

_NOT_ON_THE_MOCK = "its adapter - no launch file starts it on the mock, and what asks it there is not answered"


def bind_adapters(
    devices: Iterable[Device], controllers: Iterable[Controller], interfaces: tuple[Interface, ...]
) -> Iterator[AdaptedDevice]:
    """Yield the direct-SDK devices that no controller drives and whose adapter takes trajectories."""
    driven = {joint for controller in controllers for joint in controller.joints}
    for device in devices:
        joints = tuple(joint.name for joint in device.actuated_joints)
        if device.architecture != "direct_sdk" or not joints or not driven.isdisjoint(joints):
            continue
        action = _of_source(interfaces, device, InterfaceKind.ACTION, TRAJECTORY_ACTION)
        state = _of_source(interfaces, device, InterfaceKind.TOPIC, JOINT_STATE_TYPE)
        if action is not None and state is not None:
            yield _adapted(device, joints, action, state)


def as_driven(cell: Cell) -> Cell:
    """Return a cell whose devices have what drives them, and the procedures of their vendors that fit it.

    The driver of ROS would reach a device behind an adapter a second time. What is taken away is its hardware, its
    nodes, what both offer, and the fields of records that its controllers would tell.
    """
    behind = {adapted.device: adapted for adapted in cell.adapters}
    nodes = tuple(_with_parameters(node, behind[node.device]) if node.device in behind else node for node in cell.nodes)
    ours = tuple(node for node in nodes if node.device not in behind or node.full_name == behind[node.device].node)
    devices = (
        _adapted_device(device, behind[device.name], ours) if device.name in behind else device
        for device in cell.devices
    )
    managers = (
        replace(manager, devices=tuple(name for name in manager.devices if name not in behind))
        for manager in cell.managers
    )
    return replace(
        cell,
        devices=tuple(_with_procedures(device, "adapter" if device.name in behind else "driver") for device in devices),
        nodes=ours,
        managers=tuple(managers),
    )


def _with_parameters(node: Node, adapted: AdaptedDevice) -> Node:
    """Return the node of an adapter as the managed node that it is, with the parameters of the spec in SI units."""
    parameters: dict[str, ParameterValue] = {
        "joints": adapted.joints,
        "command_timeout": adapted.command_timeout_s,
        "stop_time": adapted.stop_time_s,
        "goal_time": adapted.goal_time_s,
        "path_tolerance": adapted.path_tolerance,
    }
    return replace(node, lifecycle=True, parameters={**node.parameters, **parameters})


def _adapted_device(device: Device, adapted: AdaptedDevice, nodes: Iterable[Node]) -> Device:
    record = tuple(source for source in device.procedures.record if source.controller_kind is None)
    limits = (*device.mock.mock_cannot_prove, _NOT_ON_THE_MOCK)
    node = next((node for node in nodes if node.full_name == adapted.node), None)
    driver = (
        None
        if node is None
        else DeviceDriver(
            node=adapted.node,
            program=f"{node.package}/{node.executable}",
            joint_states=adapted.state_topic,
            actions={Behavior.JOINT_TRAJECTORY.value: (adapted.action, TRAJECTORY_ACTION)},
        )
    )
    starts = {} if driver is None else {adapted.node: _CONNECTS}
    return replace(
        device,
        control=replace(device.control, hardware=None, driver=driver, offers=(), starts=starts),
        procedures=replace(device.procedures, record=record),
        mock=replace(device.mock, mock_cannot_prove=limits),
    )


def _with_procedures(device: Device, driven_by: str) -> Device:
    fits, own = (None, driven_by), device.procedures
    recovery = tuple(procedure for procedure in own.safety.recovery if procedure.by in fits)
    steps = tuple(step for step in own.commissioning if step.by in fits)
    safety = replace(own.safety, recovery=recovery)
    return replace(device, procedures=replace(own, safety=safety, commissioning=steps))


def _adapted(device: Device, joints: tuple[str, ...], action: Interface, state: Interface) -> AdaptedDevice:
    stated = device.control.adapter or Adapter()
    period_s = 1.0 / (state.rate_hz or DEFAULT_RATE_HZ)
    return AdaptedDevice(
        device=device.name,
        node=_end_of(action, device).full_name,
        joints=joints,
        action=action.name,
        state_topic=state.name,
        client=next((sink.node for sink in action.sinks), None),
        command_period_s=period_s,
        command_timeout_s=_or(stated.command_timeout_s, DEFAULT_TIMEOUT_PERIODS * period_s),
        stop_time_s=_or(stated.stop_time_s, DEFAULT_STOP_S),
        goal_time_s=_or(stated.goal_time_s, DEFAULT_GOAL_TIME_S),
        path_tolerance=DEFAULT_PATH_TOLERANCE if stated.path_tolerance is None else stated.path_tolerance.value,
    )


def _end_of(interface: Interface, device: Device) -> Endpoint:
    return next(source for source in interface.sources if source.node == device.name)


def _or(stated: float | None, default: float) -> float:
    return default if stated is None else stated


def _of_source(
    interfaces: tuple[Interface, ...], device: Device, kind: InterfaceKind, message_type: str
) -> Interface | None:
    for interface in interfaces:
        if any(source.node == device.name for source in interface.sources) and (
            (interface.kind, interface.type) == (kind, message_type)
        ):
            return interface
    return None
