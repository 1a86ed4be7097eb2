"""Binds one controller: its plugin for the distribution, its joints, its claims, and the targets that have them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.catalog.catalog_model import Distro
from cellc.catalog.controller_kind import ControllerKind
from cellc.catalog.device_control import PluginUse
from cellc.catalog.device_controller import PASSIVE
from cellc.cell.control import Controller, StandIn
from cellc.cell.device import Device
from cellc.cell.interface import TARGETS, ParameterValue
from cellc.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.link.controller_parameters import bind_parameters
from cellc.link.controller_plugin import behaviour_of, choose_plugin
from cellc.link.placeholders import placeholders
from cellc.link.unknown import unknown_name
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec
from cellc.spec.control import ControllerSpec


@dataclass(frozen=True, slots=True)
class ControlContext:
    """What controllers are bound against."""

    spec: CellSpec
    document: SourceDocument
    distro: Distro
    devices: Mapping[str, Device]


@dataclass(frozen=True, slots=True)
class ControllerPlace:
    """Where a controller stands: its name, the one that no other has, its manager with its namespace, its path."""

    name: str
    label: str
    manager: str
    namespace: str
    path: YamlPath


@dataclass(frozen=True, slots=True)
class _Interfaces:
    """What a controller takes: its joints, what it wants of each, and the full names of all."""

    joints: tuple[str, ...]
    claims: tuple[str, ...]
    reads: tuple[str, ...]
    command: tuple[str, ...]
    state: tuple[str, ...]


def link_controller(place: ControllerPlace, written: ControllerSpec, context: ControlContext) -> Outcome[Controller]:
    """Bind a controller; what it names and nobody has is reported."""
    device = None if written.device is None else context.devices.get(written.device)
    if written.device is not None and device is None:
        at = (*place.path, "device")
        known = context.devices
        return Outcome(None, (unknown_name("unknown-device", written.device, "device", known, context.document, at),))
    chosen = choose_plugin(written.type, place.path, device, context.distro, context.document)
    if chosen.value is None:
        return Outcome(None, chosen.diagnostics)
    plugin, kind = chosen.value
    if kind.scope == "device" and device is None:
        return Outcome(None, (_no_device(place, written, context),))
    joints = _joints(written, place.path, kind, device, context)
    interfaces = _interfaces(joints.value or (), written, kind, device, context)
    controller = _controller(place, written, device, plugin, kind, interfaces, context)
    return Outcome(controller, (*joints.diagnostics, *_unknown_client(place.path, written, context)))


def _controller(
    place: ControllerPlace,
    written: ControllerSpec,
    device: Device | None,
    plugin: PluginUse,
    kind: ControllerKind,
    interfaces: _Interfaces,
    context: ControlContext,
) -> Controller:
    targets = _targets(written, device)
    return Controller(
        name=place.name,
        path=place.path,
        span=context.document.locate(place.path),
        manager=place.manager,
        namespace=place.namespace,
        label=place.label,
        targets=targets,
        stand_in=None if device is None or "real" in targets else _stand_in(kind, device),
        kind=written.type,
        behaviour=behaviour_of(plugin, device, kind, context.distro),
        plugin=plugin.type,
        package=plugin.package,
        declared=kind,
        plugin_parameters=_plugin_parameters(written, device),
        device=written.device,
        joints=interfaces.joints,
        command_interfaces=interfaces.command,
        state_interfaces=interfaces.state,
        parameters=_parameters(written, device, plugin, kind, interfaces, context),
        written_parameters=written.parameters,
        active=written.active,
        client=written.client,
        action=None if kind.action is None else f"{place.namespace}/{place.name}/{kind.action.suffix}",
        action_type=None if kind.action is None else kind.action.types.get(context.distro),
        goal_time_s=None if written.goal_time is None else written.goal_time.si,
        path_tolerance=None if written.path_tolerance is None else written.path_tolerance.si,
        goal_tolerance=None if written.goal_tolerance is None else written.goal_tolerance.si,
        on_violation=written.on_violation,
        update_rate_hz=None if written.update_rate is None else written.update_rate.si,
    )


def _plugin_parameters(written: ControllerSpec, device: Device | None) -> frozenset[str]:
    """Name the parameters that a device's own controller has besides those of its kind."""
    own = None if device is None else device.facts.controllers.get(written.type)
    plugins = () if own is None else own.plugins.values()
    return frozenset(name for plugin in plugins for name in plugin.parameters)


def _parameters(
    written: ControllerSpec,
    device: Device | None,
    plugin: PluginUse,
    kind: ControllerKind,
    interfaces: _Interfaces,
    context: ControlContext,
) -> Mapping[str, ParameterValue]:
    values = bind_parameters(
        kind, plugin, written, interfaces.joints, interfaces.claims, interfaces.reads, device, context.distro
    )
    if device is None:
        return values
    return placeholders(device.name, device.prefix, device.spec, context.spec).fill_parameters(values)


def _targets(written: ControllerSpec, device: Device | None) -> tuple[str, ...]:
    """Return the targets whose hardware has what the controller takes."""
    if device is None:
        return TARGETS
    own = device.facts.controllers.get(written.type)
    have = TARGETS if device.hardware is None else device.hardware.targets
    return tuple(target for target in have if target == "real" or own is None or not own.real_only)


def _stand_in(kind: ControllerKind, device: Device) -> StandIn | None:
    driver = device.driver
    if driver is None or kind.kind not in driver.actions:
        return None
    action, action_type = driver.actions[kind.kind]
    return StandIn(node=driver.node, action=action, action_type=action_type)


def _interfaces(
    joints: tuple[str, ...],
    written: ControllerSpec,
    kind: ControllerKind,
    device: Device | None,
    context: ControlContext,
) -> _Interfaces:
    own = None if device is None else device.facts.controllers.get(written.type)
    if device is not None and own is not None and own.behaviour in PASSIVE:
        # It drives no joint, and names what it takes in full.
        known = placeholders(device.name, device.prefix, device.spec, context.spec)
        return _Interfaces((), (), (), tuple(map(known.fill, own.claims)), tuple(map(known.fill, own.reads)))
    claims = (
        written.command_interfaces or (own.command_interfaces if own is not None else ()) or kind.command_interfaces
    )
    reads = _read(kind, joints, device)
    command = tuple(f"{joint}/{claim}" for joint in joints for claim in claims)
    state = tuple(f"{joint}/{read}" for joint in joints for read in reads)
    return _Interfaces(joints, claims, reads, command, state)


def _no_device(place: ControllerPlace, written: ControllerSpec, context: ControlContext) -> Diagnostic:
    return Diagnostic(
        code="controller-without-device",
        severity=Severity.ERROR,
        message=f"controller `{place.name}` of kind `{written.type}` drives no device",
        span=context.document.locate_key(place.path),
        yaml_path=place.path,
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


def _read(kind: ControllerKind, joints: tuple[str, ...], device: Device | None) -> tuple[str, ...]:
    """Return the state interfaces of the kind that every joint offers, in the kind's order."""
    if device is None:
        return kind.state_interfaces
    offered = [joint.state_interfaces for joint in device.joints if joint.name in joints]
    return tuple(state for state in kind.state_interfaces if all(state in states for states in offered))


def _unknown_client(path: YamlPath, written: ControllerSpec, context: ControlContext) -> tuple[Diagnostic, ...]:
    if written.client is None or written.client in context.spec.nodes:
        return ()
    known, at = context.spec.nodes, (*path, "client")
    return (unknown_name("unknown-node", written.client, "node", known, context.document, at),)
