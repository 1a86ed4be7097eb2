"""What moves a real device and what pretends to: the component of ros2_control, or the driver, and their effects."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from cellc.catalog.device_interfaces import GroupInterfaces, HardwareFacts
from cellc.catalog.device_model import DeviceModel
from cellc.catalog.effects import EffectFacts
from cellc.cell.device import DeviceDriver, Effect, HardwareComponent, InterfaceGroup, OfferedInterface
from cellc.cell.interface import InterfaceKind
from cellc.link.names import Placeholders
from cellc.vocabulary import Distro, Unmet


def hardware_component(
    facts: DeviceModel, known: Placeholders, prefix: str, distro: Distro | None, driver: str
) -> HardwareComponent | None:
    """Return the component of a device; None where no plugin moves it on any target.

    Args:
        distro: the distribution of the cell; None where it names none that is known.
        driver: the pinned driver as written, its version last.
    """
    control = facts.control
    if control is None:
        return None
    real = control.hardware.real
    by_target = {"mock": control.hardware.mock} | ({} if real is None else {"real": real})
    component = HardwareComponent(
        name=known.fill(control.component),
        targets=tuple(by_target),
        plugins={target: hardware.plugin for target, hardware in by_target.items()},
        parameters={target: _parameters(one, known, distro, driver) for target, one in by_target.items()},
        sensors=_groups(control.sensors, prefix),
        gpios=_groups(control.gpios, prefix),
    )
    return component if real is None else _with_effects(component, real, distro)


def _parameters(hardware: HardwareFacts, known: Placeholders, distro: Distro | None, driver: str) -> dict[str, str]:
    """Return what the plugin is given: what all releases read, and what the one that runs here reads besides."""
    release = None if distro is None else hardware.release(distro, driver.split()[-1])
    own = {} if release is None else release.parameters
    filled = {key: known.fill(value) for key, value in {**hardware.parameters, **own}.items()}
    return {key: value for key, value in filled.items() if value or key not in hardware.left_out_when_empty}


def _with_effects(component: HardwareComponent, real: HardwareFacts, distro: Distro | None) -> HardwareComponent:
    start, timeout = real.start, real.command_timeout
    return replace(
        component,
        effects={moment: effect(facts, distro) for moment, facts in real.effects.items()},
        initial_state="active" if start is None else start.initial_state,
        at_once=start is not None and start.at_once,
        command_timeout_s=None if timeout is None else timeout.si,
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
    )


def started_nodes(facts: DeviceModel, known: Placeholders, distro: Distro | None) -> dict[str, Effect]:
    """Return what the start of each node of the driver does, by its full name, where the catalog tells."""
    told = ((node.name, node.effect) for node in facts.nodes)
    return {f"/{known.fill(name)}": effect(one, distro) for name, one in told if one is not None}


def offered_interfaces(facts: DeviceModel, known: Placeholders, distro: Distro | None) -> Iterator[OfferedInterface]:
    """Yield what the driver offers, topics first, then services and actions."""
    offered = (
        *((InterfaceKind.TOPIC, topic.name, topic.type, topic.publisher, None) for topic in facts.topics),
        *((InterfaceKind.SERVICE, one.name, one.type, one.server, one.effect) for one in facts.services),
        *((InterfaceKind.ACTION, one.name, one.type, one.server, one.effect) for one in facts.actions),
    )
    for kind, name, type_, node, does in offered:
        yield OfferedInterface(
            kind=kind,
            name=known.fill(name),
            type=type_,
            node="/" + known.fill(node),
            effect=None if does is None else effect(does, distro),
        )


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
    )


def _groups(groups: Mapping[str, GroupInterfaces], prefix: str) -> tuple[InterfaceGroup, ...]:
    return tuple(
        InterfaceGroup(
            name=name if entry.fixed_name else prefix + name,
            command_interfaces=entry.command,
            state_interfaces=entry.state,
            initial=dict(entry.initial),
            real_only=entry.real_only,
        )
        for name, entry in groups.items()
    )
