"""What moves a real device and what pretends to: the component of ros2_control, or the driver, and their effects."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import replace

from cellc.compiler.catalog.device_graph import NodeFacts
from cellc.compiler.catalog.device_interfaces import (
    GroupInterfaces,
    HardwareFacts,
    HardwareRelease,
    JointInterfaces,
    counted,
)
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.effects import EffectFacts
from cellc.compiler.cell.hardware import (
    CommandModes,
    DeviceDriver,
    Effect,
    HardwareComponent,
    InterfaceGroup,
    NeedReport,
    OfferedInterface,
)
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.link.names import JOINT_STATES, Placeholders
from cellc.compiler.link.programs import inner_nodes
from cellc.compiler.spec.devices import DeviceSpec
from cellc.contract.entities import Target
from cellc.contract.pins import older
from cellc.contract.vocabulary import UNKNOWN, Distro, InterfaceKind, Unmet


def hardware_component(
    facts: DeviceModel,
    known: Placeholders,
    prefix: str,
    distro: Distro | None,
    driver: str,
    stated: Mapping[str, str],
) -> HardwareComponent | None:
    """Return the component of a device; None where no plugin moves it on any target.

    Args:
        distro: the distribution of the cell; None where it names none that is known.
        driver: the pinned driver as written, its version last.
        stated: parameters of the real plugin that follow from the spec.
    """
    control = facts.control
    if control is None:
        return None
    real = control.hardware.real
    release = None if real is None or distro is None else real.release(distro, driver)
    parameters = {"mock": _parameters(control.hardware.mock, known, None)}
    if real is not None:
        parameters["real"] = {**_parameters(real, known, release), **stated}
    by_target: dict[Target, HardwareFacts] = {"mock": control.hardware.mock}
    if real is not None:
        by_target["real"] = real
    component = HardwareComponent(
        name=known.fill(control.component),
        targets=tuple(by_target),
        kinds={target: hardware.component for target, hardware in by_target.items()},
        plugins={target: hardware.plugin for target, hardware in by_target.items()},
        parameters=parameters,
        sensors=_groups(control.sensors, prefix),
        gpios=_groups(control.gpios, prefix, None if release is None else release.exports),
        enforce_command_limits=control.enforce_command_limits,
    )
    if real is None:
        return component
    nodes = inner_nodes(real.nodes, "", distro, known.fill)
    component = _with_effects(component, real, distro)
    modes = _modes(real, control.gpios, prefix)
    return replace(component, nodes=nodes, modes=modes, fixed_joint_names=real.fixed_joint_names)


def _modes(real: HardwareFacts, gpios: Container[str], prefix: str) -> CommandModes | None:
    modes = real.modes
    if modes is None:
        return None
    full = {name: prefix + name if name in gpios else name for name in modes.names}
    pairs = (frozenset((full[first], full[other])) for first, other in modes.together)
    return CommandModes(names=frozenset(full.values()), together=frozenset(pairs))


def _parameters(hardware: HardwareFacts, known: Placeholders, release: HardwareRelease | None) -> dict[str, str]:
    """Return what the plugin is given: what all releases read, and what the one that runs here reads besides."""
    parameters = {} if release is None else release.parameters
    filled = {key: known.fill(value) for key, value in {**hardware.parameters, **parameters}.items()}
    return {key: value for key, value in filled.items() if value or key not in hardware.left_out_when_empty}


def _with_effects(component: HardwareComponent, real: HardwareFacts, distro: Distro | None) -> HardwareComponent:
    start, timeout = real.start, real.command_timeout
    return replace(
        component,
        effects={moment: effect(facts, distro) for moment, facts in real.effects.items()},
        initial_state="active" if start is None else start.initial_state,
        direct_activation=start is not None and start.direct_activation,
        command_timeout_s=None if timeout is None else timeout.si,
        reported_by={
            need: NeedReport(
                controller_kind=status.controller,
                topic=status.topic,
                type=status.type,
                field=status.field,
                values=status.values,
                above=status.above,
            )
            for need, status in real.reported_by.items()
        },
    )


def effect(facts: EffectFacts, distro: Distro | None) -> Effect:
    """Return what a moment does in the distribution of the cell."""
    return Effect(
        motion=facts.motion,
        authority=facts.authority,
        lock=facts.lock,
        needs={need: Unmet.UNKNOWN if distro is None else facts.unmet(need, distro) for need in facts.needs},
        drops_part=facts.drops_part,
        leaves=facts.leaves,
        does=facts.does,
        ends=facts.ends,
        largest_step=None if facts.largest_step is None else facts.largest_step.si,
    )


def run_nodes(facts: DeviceModel, known: Placeholders, firmware: str) -> tuple[NodeFacts, ...]:
    """Return the nodes of the driver that this cell runs: none that would wait for ever, or end immediately.

    Args:
        firmware: that of the device as written, its product first.
    """
    return tuple(
        node
        for node in facts.nodes
        if (node.needs_controller is None or f"controller_{node.needs_controller}" in known.values)
        and not any(
            firmware.split()[0] == product and older(firmware, least) for product, least in node.firmware.items()
        )
    )


def camera_parameters(facts: DeviceModel, written: DeviceSpec) -> dict[str, ParameterValue]:
    """Return what the node of a camera gets of the exposure and the serial that the spec states."""
    camera, serial = facts.camera, written.serial
    if camera is None:
        return {}
    parameters: dict[str, ParameterValue] = {}
    exposure = None if written.stamp is None else written.stamp.exposure
    if exposure is not None:
        parameters |= dict.fromkeys(camera.auto_exposure_parameters, False)
        parameters |= {name: round(exposure.si / unit.si) for name, unit in camera.exposure_parameters.items()}
    if camera.serial_parameter is not None and serial != UNKNOWN:
        parameters[camera.serial_parameter] = f"_{serial}"
    return parameters


def started_nodes(nodes: Iterable[NodeFacts], known: Placeholders, distro: Distro | None) -> dict[str, Effect]:
    """Return what the start of each node of the driver does, by its full name, where the catalog tells."""
    effects = ((node.name, node.effect) for node in nodes)
    return {
        f"/{known.fill(name)}": effect(effect_facts, distro)
        for name, effect_facts in effects
        if effect_facts is not None
    }


def offered_interfaces(
    facts: DeviceModel, nodes: Iterable[NodeFacts], known: Placeholders, distro: Distro | None
) -> Iterator[OfferedInterface]:
    """Yield what the driver offers in this distribution, topics first, then services and actions, as the cell has it.

    Args:
        nodes: those that run; what another one would offer is not there.
    """
    remaps = {node.name: driver_remaps(facts, node, known) for node in nodes}
    absent = {node.name for node in facts.nodes} - set(remaps)
    offered = (
        *((InterfaceKind.TOPIC, topic.name, topic.type, topic.publisher, None) for topic in facts.topics),
        *(
            (InterfaceKind.SERVICE, service.name, service.type, service.server, service.effect)
            for service in facts.services
        ),
        *(
            (InterfaceKind.ACTION, action.name, action.type, action.server, action.effect)
            for action in facts.actions
            if not action.only or distro in action.only
        ),
    )
    for kind, name, type_, node, does in offered:
        if node not in absent:
            said = known.fill(name)
            yield OfferedInterface(
                kind=kind,
                name=remaps.get(node, {}).get(said, said),
                type=type_,
                node="/" + known.fill(node),
                effect=None if does is None else effect(does, distro),
            )


def driver_remaps(facts: DeviceModel, node: NodeFacts, known: Placeholders) -> dict[str, str]:
    """Return names of a node of the driver → those of the cell: joint states join those of the controller managers."""
    driver = facts.driver
    states = driver.joint_states if driver is not None and driver.node == node.name else None
    joined = {} if states is None else {states: JOINT_STATES}
    return {known.fill(name): known.fill(target) for name, target in (joined | node.remaps).items()}


def device_driver(facts: DeviceModel, known: Placeholders) -> DeviceDriver | None:
    """Return the node that moves a device on the real target past ros2_control; None where none does."""
    driver = facts.driver
    if driver is None:
        return None
    program = next(f"{node.package}/{node.executable}" for node in facts.nodes if node.name == driver.node)
    types = {action.name: action.type for action in facts.actions}
    return DeviceDriver(
        node="/" + known.fill(driver.node),
        program=program,
        joint_states=None if driver.joint_states is None else known.fill(driver.joint_states),
        actions={kind: (known.fill(action), types[action]) for kind, action in driver.actions.items()},
        goal_unit=driver.goal_unit,
    )


def _groups(
    groups: Mapping[str, GroupInterfaces], prefix: str, further: Mapping[str, JointInterfaces] | None = None
) -> tuple[InterfaceGroup, ...]:
    """Return sensors or gpios; ``further`` are interfaces that one release of the driver exports besides."""
    more = {} if further is None else further
    return tuple(
        InterfaceGroup(
            name=name if entry.fixed_name else prefix + name,
            command_interfaces=tuple(counted((*entry.command, *(more[name].command if name in more else ())))),
            state_interfaces=tuple(counted((*entry.state, *(more[name].state if name in more else ())))),
            initial=dict(entry.initial),
            real_only=entry.real_only,
            declared=not entry.undeclared,
        )
        for name, entry in groups.items()
    )
