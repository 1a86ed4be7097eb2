"""Binds one controller: its plugin for the distribution, its joints, its claims, and the targets that have them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property

from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.catalog.device_controller import DeviceController
from cellc.compiler.catalog.device_interfaces import CommandFacts, PluginUse
from cellc.compiler.cell.control import Controller, OnReal, StandIn, VendorCommand
from cellc.compiler.cell.device import Device, DeviceJoint
from cellc.compiler.cell.hardware import Effect
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.link.controller_choice import choose_kind
from cellc.compiler.link.controller_parameters import bind_parameters, bind_topics
from cellc.compiler.link.devices import BoundDevice
from cellc.compiler.link.hardware import effect
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import si
from cellc.compiler.link.tolerances import UNSTATED, Tolerances, bind_tolerances, unknown_joints
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.control import ControllerSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.entities import TARGETS, Target
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import OF_ONE_DEVICE, Behavior, Distro

_MOVES_THE_MOCK = {"position", "velocity", "acceleration"}


# Without slots, so that what every controller asks for is looked up once and kept.
@dataclass(frozen=True)
class ControlContext:
    """What controllers are bound against."""

    spec: CellSpec
    document: SourceDocument
    distro: Distro
    devices: Mapping[str, BoundDevice]

    @cached_property
    def joints(self) -> Mapping[str, DeviceJoint]:
        """Joints of all devices by `device/joint`."""
        bound = self.devices.items()
        return {f"{name}/{joint.local_name}": joint for name, holder in bound for joint in holder.device.joints}

    @cached_property
    def labels(self) -> Mapping[str, tuple[str, ...]]:
        """The same labels by the full name of a joint, in their order."""
        names: dict[str, list[str]] = {}
        for label, joint in self.joints.items():
            names.setdefault(joint.name, []).append(label)
        return {name: tuple(labels) for name, labels in names.items()}

    @cached_property
    def beyond_the_mock(self) -> frozenset[str]:
        """Interfaces of groups that the real hardware alone has."""
        hardware = [bound.device.control.hardware for bound in self.devices.values()]
        groups = [group for item in hardware if item is not None for group in (*item.sensors, *item.gpios)]
        return frozenset(
            f"{group.name}/{name}"
            for group in groups
            if group.real_only or not group.declared
            for name in (*group.command_interfaces, *group.state_interfaces)
        )


@dataclass(frozen=True, slots=True)
class ControllerPlace:
    """Where a controller is: its name, the one that no other has, its manager with its namespace, its path."""

    name: str
    label: str
    manager: str
    namespace: str
    path: YamlPath


@dataclass(frozen=True, slots=True)
class _Chosen:
    """What a controller is: its kind and plugin, the device that it drives, and the device's own entry for its type."""

    kind: ControllerKind
    plugin: PluginUse
    bound: BoundDevice | None
    own: DeviceController | None

    @property
    def device(self) -> Device | None:
        """The device that it drives."""
        return None if self.bound is None else self.bound.device

    @property
    def on_real(self) -> CommandFacts | None:
        """What the vendor claims and tells on real hardware with a controller of this kind."""
        control = None if self.bound is None else self.bound.facts.control
        real = None if control is None else control.hardware.real
        return None if real is None else real.commands.get(self.kind.kind)


@dataclass(frozen=True, slots=True)
class _Interfaces:
    """What a controller takes: its joints, what it wants and allows of each, and the full names of all."""

    joints: tuple[str, ...]
    claims: tuple[str, ...]
    reads: tuple[str, ...]
    command: tuple[str, ...]
    state: tuple[str, ...]
    tolerances: Tolerances


def link_controller(place: ControllerPlace, written: ControllerSpec, context: ControlContext) -> Outcome[Controller]:
    """Bind a controller; a diagnostic for each name that does not exist."""
    bound = None if written.device is None else context.devices.get(written.device)
    if written.device is not None and bound is None:
        at = (*place.path, "device")
        known = context.devices
        return Outcome(None, (unknown_name("unknown-device", written.device, "device", known, context.document, at),))
    choice = _choose(written.type, (*place.path, "type"), bound, context)
    if choice.value is None:
        return Outcome(None, choice.diagnostics)
    chosen = choice.value
    if chosen.kind.scope == "device" and bound is None:
        return Outcome(None, (_no_device(place, written, context),))
    joints = _joints(written, place.path, chosen, context)
    interfaces = _interfaces(joints.value or (), written, chosen)
    named = dict.fromkeys(label for joint in interfaces.joints for label in context.labels.get(joint, ()))
    driven = {label: context.joints[label] for label in named if label in context.joints}
    tolerances = bind_tolerances(written, driven)
    controller = _controller(place, written, chosen, replace(interfaces, tolerances=tolerances), context)
    unknown = unknown_joints(written, driven, context.document, place.path)
    return Outcome(controller, (*joints.diagnostics, *unknown, *_unknown_client(place.path, written, context)))


def _choose(type_: str, at: YamlPath, bound: BoundDevice | None, context: ControlContext) -> Outcome[_Chosen]:
    """Choose kind and plugin of a type for the distribution."""
    kind = choose_kind(type_, bound, context.distro, context.document, at)
    if kind.value is None:
        return Outcome(None, kind.diagnostics)
    variant = None if bound is None else bound.facts.controllers.get(type_)
    plugins = kind.value.plugins if variant is None else variant.plugins
    return Outcome(_Chosen(kind.value, plugins[context.distro], bound, variant))


def _controller(
    place: ControllerPlace,
    written: ControllerSpec,
    chosen: _Chosen,
    interfaces: _Interfaces,
    context: ControlContext,
) -> Controller:
    device, kind, plugin = chosen.device, chosen.kind, chosen.plugin
    targets, vendor = _targets(chosen, interfaces, context), chosen.on_real
    own, parameters = f"{place.namespace}/{place.name}", _parameters(written, chosen, interfaces, context)
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
        behavior=_behavior(chosen, context.distro),
        plugin=plugin.type,
        package=plugin.package,
        declared=kind,
        own_topics=tuple(bind_topics(kind, place.namespace, own, parameters, context.distro)),
        calls=dict(_calls(kind, own, context.distro)),
        vendor_parameters=_vendor_parameters(chosen),
        plugin_parameters=_plugin_parameters(chosen.own),
        device=written.device,
        joints=interfaces.joints,
        command_interfaces=interfaces.command,
        on_real=_on_real(written, chosen, interfaces, context) if "real" in targets else None,
        vendor=None if vendor is None else VendorCommand(interfaces=vendor.interfaces, because=vendor.because),
        state_interfaces=interfaces.state,
        parameters=parameters,
        written_parameters=written.parameters,
        active=written.active,
        client=written.client,
        action=None if kind.action is None else f"{own}/{kind.action.suffix}",
        action_type=None if kind.action is None else kind.action.types.get(context.distro),
        goal_time_s=si(written.goal_time),
        path_tolerance=interfaces.tolerances.path,
        goal_tolerance=interfaces.tolerances.goal,
        on_violation=written.on_violation,
        update_rate_hz=si(written.update_rate),
    )


def _calls(kind: ControllerKind, full_name: str, distro: Distro) -> Iterator[tuple[str, Effect]]:
    for service in kind.services:
        if service.effect is not None:
            yield service.name.replace("~", full_name), effect(service.effect, distro)


def _behavior(chosen: _Chosen, distro: Distro) -> Behavior:
    """Return the behavior of a plugin: that of its kind, unless the distribution's plugin differs.

    A trajectory controller whose parameters name the device's speed scaling follows it.
    """
    usual = chosen.plugin.behavior or chosen.kind.kind
    neutral = chosen.kind.plugins.get(distro)
    scaling = None if chosen.bound is None else chosen.bound.facts.speed_scaling
    if usual is not Behavior.JOINT_TRAJECTORY or scaling is None:
        return usual
    if neutral is not None and neutral.type == chosen.plugin.type:
        return usual  # where the upstream plugin is used it takes the factor by parameters of its own
    follows = scaling.state_interface in chosen.plugin.parameters.values()
    return Behavior.SCALED_JOINT_TRAJECTORY if follows else usual


def _vendor_parameters(chosen: _Chosen) -> Mapping[str, ParameterValue]:
    told = chosen.plugin.parameters | ({} if chosen.on_real is None else chosen.on_real.parameters)
    return told if chosen.bound is None or not told else chosen.bound.names.fill_parameters(told)


def _plugin_parameters(own: DeviceController | None) -> frozenset[str]:
    """Name the parameters that a device's own controller has besides those of its kind."""
    plugins = () if own is None else own.plugins.values()
    return frozenset(name for plugin in plugins for name in plugin.parameters)


def _parameters(
    written: ControllerSpec, chosen: _Chosen, interfaces: _Interfaces, context: ControlContext
) -> Mapping[str, ParameterValue]:
    joints, claims, reads = interfaces.joints, interfaces.claims, interfaces.reads
    values = bind_parameters(
        chosen.kind, chosen.plugin, written, joints, claims, reads, chosen.device, interfaces.tolerances, context.distro
    )
    return values if chosen.bound is None else chosen.bound.names.fill_parameters(values)


def _on_real(
    written: ControllerSpec, chosen: _Chosen, interfaces: _Interfaces, context: ControlContext
) -> OnReal | None:
    """Return what the vendor's own configuration claims and tells; None where the spec states its interfaces."""
    facts = chosen.on_real
    if facts is None or written.command_interfaces or (chosen.own is not None and chosen.own.command_interfaces):
        return None
    command = tuple(f"{joint}/{claim}" for joint in interfaces.joints for claim in facts.interfaces)
    plugin = chosen.plugin.model_copy(update={"parameters": chosen.plugin.parameters | facts.parameters})
    there = replace(interfaces, claims=facts.interfaces, command=command)
    parameters = _parameters(written, replace(chosen, plugin=plugin), there, context)
    same = command == interfaces.command and not facts.parameters
    return None if same else OnReal(command_interfaces=command, parameters=parameters)


def _targets(chosen: _Chosen, interfaces: _Interfaces, context: ControlContext) -> tuple[Target, ...]:
    """Return the targets whose hardware has what the controller takes, of each device whose joints it has."""
    facts = chosen.own
    components = [
        device.control.hardware
        for device in _taken_from(chosen, interfaces, context)
        if device.control.hardware is not None
    ]
    have = tuple(target for target in TARGETS if all(target in component.targets for component in components))
    lacks = (facts is not None and facts.real_only) or _beyond_the_mock(interfaces, context)
    return tuple(target for target in have if target == "real" or not (lacks and "real" in have))


def _taken_from(chosen: _Chosen, interfaces: _Interfaces, context: ControlContext) -> Iterator[Device]:
    if chosen.device is not None:
        yield chosen.device
    labels = (label for joint in interfaces.joints for label in context.labels.get(joint, ()))
    named = {label.partition("/")[0] for label in labels}
    yield from (bound.device for name, bound in context.devices.items() if name in named)


def _beyond_the_mock(interfaces: _Interfaces, context: ControlContext) -> bool:
    """Tell whether a controller takes what mock hardware lacks: a group of the real one, or joints by effort alone.

    GenericSystem refuses a claim of joints without position, velocity or acceleration, as was observed
    (mock_components of ros2_control 5.16).
    """
    if interfaces.claims and not set(interfaces.claims) & _MOVES_THE_MOCK:
        return True
    return not context.beyond_the_mock.isdisjoint((*interfaces.command, *interfaces.state))


def _stand_in(kind: ControllerKind, device: Device) -> StandIn | None:
    driver = device.control.driver
    if driver is None or kind.kind not in driver.actions:
        return None
    action, action_type = driver.actions[kind.kind]
    return StandIn(node=driver.node, action=action, action_type=action_type, unit=driver.goal_unit)


def _interfaces(joints: tuple[str, ...], written: ControllerSpec, chosen: _Chosen) -> _Interfaces:
    kind, bound, facts = chosen.kind, chosen.bound, chosen.own
    if bound is not None and facts is not None and facts.behavior in OF_ONE_DEVICE:
        # It drives no joint, and names what it takes in full.
        command, state = (tuple(map(bound.names.fill, names)) for names in facts.taken(chosen.plugin))
        return _Interfaces((), (), (), command, state, UNSTATED)
    if kind.kind is Behavior.GPIO_COMMAND:
        command, state = (_of_gpios(written, which, bound) for which in ("command", "state"))
        return _Interfaces((), (), (), command, state, UNSTATED)
    claims = (
        written.command_interfaces or (facts.command_interfaces if facts is not None else ()) or kind.command_interfaces
    )
    reads = _read(kind, joints, chosen.device)
    command = tuple(f"{joint}/{claim}" for joint in joints for claim in claims)
    state = tuple(f"{joint}/{read}" for joint in joints for read in reads)
    return _Interfaces(joints, claims, reads, command, state, UNSTATED)


def _of_gpios(written: ControllerSpec, which: str, bound: BoundDevice | None) -> tuple[str, ...]:
    """Return the interfaces of gpios that the parameters name, in full; ``which`` is command or state."""
    gpios, named = written.parameters.get("gpios", ()), written.parameters
    names = (
        f"{gpio}/{interface}"
        for gpio in (gpios if isinstance(gpios, tuple) else ())
        if isinstance(interfaces := named.get(f"{which}_interfaces.{gpio}.interfaces"), tuple)
        for interface in interfaces
    )
    return tuple(names if bound is None else map(bound.names.fill, names))


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
    written: ControllerSpec, path: YamlPath, chosen: _Chosen, context: ControlContext
) -> Outcome[tuple[str, ...]]:
    if not written.joints:
        return Outcome(() if chosen.device is None else _default_joints(chosen.kind, chosen.device))
    known = context.joints
    problems = tuple(
        unknown_name("unknown-joint", joint, "joint", known, context.document, (*path, "joints", index))
        for index, joint in enumerate(written.joints)
        if joint not in known
    )
    return Outcome(tuple(known[joint].name for joint in written.joints if joint in known), problems)


def _default_joints(kind: ControllerKind, device: Device) -> tuple[str, ...]:
    """Return the joints that a kind drives where the spec names none: those of the fingers and of the arm are apart."""
    fingers = () if device.gripper is None else (device.gripper.joint,)
    if kind.single_joint and fingers:
        return fingers
    joints = tuple(joint.name for joint in device.actuated_joints)
    if kind.single_joint:
        return joints[:1]
    return tuple(joint for joint in joints if joint not in fingers) or joints


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
