"""Binds controller managers: each controller to its plugin for the distribution, its joints and its claims."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.catalog.catalog_model import Distro
from cellc.catalog.controller_kind import ControllerKind
from cellc.catalog.device_control import PluginUse
from cellc.catalog.load import controller_kinds
from cellc.cell.control import Controller, ControllerManager, ControllerSwitch
from cellc.cell.device import Device
from cellc.cell.interface import ParameterValue
from cellc.diagnostics import Diagnostic, Outcome, Severity, YamlPath, did_you_mean
from cellc.link.controller_parameters import bind_parameters
from cellc.link.placeholders import placeholders
from cellc.link.unknown import unknown_name
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec
from cellc.spec.control import ControllerSpec, ManagerSpec


@dataclass(frozen=True, slots=True)
class ControlContext:
    """What controllers are bound against."""

    spec: CellSpec
    document: SourceDocument
    distro: Distro
    devices: Mapping[str, Device]
    kinds: Mapping[str, ControllerKind]


def link_managers(context: ControlContext) -> Outcome[tuple[ControllerManager, ...]]:
    """Bind every controller manager of the spec."""
    managers: list[ControllerManager] = []
    problems: list[Diagnostic] = []
    for name, path, written in _written_managers(context.spec):
        bound = _manager(name, path, written, context)
        problems += bound.diagnostics
        if bound.value is not None:
            managers.append(bound.value)
    return Outcome(tuple(managers), tuple(problems))


def _written_managers(spec: CellSpec) -> tuple[tuple[str, YamlPath, ManagerSpec], ...]:
    single: tuple[tuple[str, YamlPath, ManagerSpec], ...] = ()
    if spec.control is not None:
        single = (("control", ("control",), spec.control),)
    return single + tuple((name, ("managers", name), written) for name, written in spec.managers.items())


def _manager(name: str, path: YamlPath, written: ManagerSpec, context: ControlContext) -> Outcome[ControllerManager]:
    controllers: list[Controller] = []
    problems: list[Diagnostic] = []
    document = context.document
    if written.host is not None and written.host not in context.spec.hosts:
        at = (*path, "host")
        problems.append(unknown_name("unknown-host", written.host, "host", context.spec.hosts, document, at))
    for key, entry in written.controllers.items():
        bound = _controller(key, (*path, "controllers", key), entry, name, written.namespace, context)
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
        host=written.host,
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
    with_hardware = tuple(name for name, device in context.devices.items() if device.hardware is not None)
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


def _controller(
    name: str, path: YamlPath, written: ControllerSpec, manager: str, namespace: str, context: ControlContext
) -> Outcome[Controller]:
    device = None if written.device is None else context.devices.get(written.device)
    if written.device is not None and device is None:
        at = (*path, "device")
        known = context.devices
        return Outcome(None, (unknown_name("unknown-device", written.device, "device", known, context.document, at),))
    chosen = _plugin(written, path, device, context)
    if chosen.value is None:
        return Outcome(None, chosen.diagnostics)
    plugin, kind = chosen.value
    if kind.scope == "device" and device is None:
        return Outcome(None, (_no_device(name, written, path, context),))
    joints = _joints(written, path, kind, device, context)
    client = _unknown_client(written, path, context)
    claims = _claimed(written, device, kind)
    states = _read(kind, joints.value or (), device)
    parameters = bind_parameters(kind, plugin, written, joints.value or (), claims, states, device, context.distro)
    controller = Controller(
        name=name,
        path=path,
        span=context.document.locate(path),
        manager=manager,
        kind=written.type,
        behaviour=_behaviour(plugin, device, kind, context),
        plugin=plugin.type,
        device=written.device,
        joints=joints.value or (),
        command_interfaces=tuple(f"{joint}/{claim}" for joint in joints.value or () for claim in claims),
        state_interfaces=tuple(f"{joint}/{state}" for joint in joints.value or () for state in states),
        parameters=_filled(parameters, device, context),
        active=written.active,
        client=written.client,
        action=None if kind.action is None else f"{namespace}/{name}/{kind.action.suffix}",
        action_type=None if kind.action is None else kind.action.types.get(context.distro),
        goal_time_s=None if written.goal_time is None else written.goal_time.si,
        path_tolerance=None if written.path_tolerance is None else written.path_tolerance.si,
        goal_tolerance=None if written.goal_tolerance is None else written.goal_tolerance.si,
        on_violation=written.on_violation,
        update_rate_hz=None if written.update_rate is None else written.update_rate.si,
    )
    return Outcome(controller, (*joints.diagnostics, *client))


def _filled(
    parameters: Mapping[str, ParameterValue], device: Device | None, context: ControlContext
) -> Mapping[str, ParameterValue]:
    if device is None:
        return parameters
    return placeholders(device.name, device.prefix, device.spec, context.spec).fill_parameters(parameters)


def _plugin(
    written: ControllerSpec, path: YamlPath, device: Device | None, context: ControlContext
) -> Outcome[tuple[PluginUse, ControllerKind]]:
    """Choose the plugin of a kind for the distribution: the device's own kinds come before the neutral ones."""
    own = {} if device is None else device.facts.controllers
    # A device may list kinds that act as none of the neutral ones, such as a vendor's own broadcaster: not offered yet.
    offered = {name: one for name, one in own.items() if one.behaviour in context.kinds}
    if written.type in offered:
        plugins, kind = offered[written.type].plugins, context.kinds[offered[written.type].behaviour]
    elif written.type in context.kinds:
        kind = context.kinds[written.type]
        plugins = kind.plugins
    else:
        return Outcome(None, (_unknown_kind(written, path, offered, context),))
    if context.distro in plugins:
        return Outcome((plugins[context.distro], kind))
    at = (*path, "type")
    problem = Diagnostic(
        code="controller-not-in-distro",
        severity=Severity.ERROR,
        message=f"`{written.type}` does not exist on {context.distro}, only on {', '.join(plugins)}",
        span=context.document.locate(at),
        yaml_path=at,
        help="choose a kind that the pinned distribution has",
    )
    return Outcome(None, (problem,))


def _behaviour(plugin: PluginUse, device: Device | None, kind: ControllerKind, context: ControlContext) -> str:
    """Return the neutral kind; a trajectory controller that is told of the device's speed scaling follows it."""
    neutral = kind.plugins.get(context.distro)
    scaling = None if device is None else device.facts.speed_scaling
    if scaling is None or (neutral is not None and neutral.type == plugin.type):
        return kind.kind  # where the upstream plugin is used it takes the factor by parameters of its own
    return f"scaled_{kind.kind}" if scaling.state_interface in plugin.parameters.values() else kind.kind


def _unknown_kind(
    written: ControllerSpec, path: YamlPath, own: Mapping[str, object], context: ControlContext
) -> Diagnostic:
    at = (*path, "type")
    known = (*own, *controller_kinds())
    return Diagnostic(
        code="unknown-controller-kind",
        severity=Severity.ERROR,
        message=f"there is no kind of controller `{written.type}`",
        span=context.document.locate(at),
        yaml_path=at,
        help=did_you_mean(written.type, known, "kinds of controllers"),
    )


def _no_device(name: str, written: ControllerSpec, path: YamlPath, context: ControlContext) -> Diagnostic:
    return Diagnostic(
        code="controller-without-device",
        severity=Severity.ERROR,
        message=f"controller `{name}` of kind `{written.type}` drives no device",
        span=context.document.locate_key(path),
        yaml_path=path,
        help=f"add `device:` with one of {', '.join(f'`{device}`' for device in context.devices)}",
    )


def _joints(
    written: ControllerSpec, path: YamlPath, kind: ControllerKind, device: Device | None, context: ControlContext
) -> Outcome[tuple[str, ...]]:
    if not written.joints:
        return Outcome(() if device is None else _default_joints(kind, device))
    known = {f"{name}/{joint.local_name}": joint.name for name, one in context.devices.items() for joint in one.joints}
    problems = tuple(
        unknown_name("unknown-joint", joint, "joint", known, context.document, (*path, "joints", index))
        for index, joint in enumerate(written.joints)
        if joint not in known
    )
    return Outcome(tuple(known[joint] for joint in written.joints if joint in known), problems)


def _default_joints(kind: ControllerKind, device: Device) -> tuple[str, ...]:
    if kind.single_joint and device.facts.gripper is not None:
        return (device.prefix + device.facts.gripper.joint,)
    return tuple(joint.name for joint in device.actuated_joints)


def _claimed(written: ControllerSpec, device: Device | None, kind: ControllerKind) -> tuple[str, ...]:
    """Return what the spec claims, or the kind of the device, or the neutral kind."""
    own = None if device is None else device.facts.controllers.get(written.type)
    return written.command_interfaces or (own.command_interfaces if own is not None else ()) or kind.command_interfaces


def _read(kind: ControllerKind, joints: tuple[str, ...], device: Device | None) -> tuple[str, ...]:
    """Return the state interfaces of the kind that every joint offers, in the kind's order."""
    if device is None:
        return kind.state_interfaces
    offered = [joint.state_interfaces for joint in device.joints if joint.name in joints]
    return tuple(state for state in kind.state_interfaces if all(state in states for states in offered))


def _unknown_client(written: ControllerSpec, path: YamlPath, context: ControlContext) -> tuple[Diagnostic, ...]:
    if written.client is None or written.client in context.spec.nodes:
        return ()
    known, at = context.spec.nodes, (*path, "client")
    return (unknown_name("unknown-node", written.client, "node", known, context.document, at),)
