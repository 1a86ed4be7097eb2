"""Rules on who says how things are: each state has one publisher."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.link.derived import JOINT_STATE_TYPE
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.entities import Target
from cellc.contract.vocabulary import InterfaceKind

_Part = tuple[Target, str]
"""What a sample speaks of, on a target: a joint; of other topics the whole."""


@rule(Severity.ERROR, assumes=("shared-prefix", "second-command-publisher", "device-of-two-managers"))
def second_state_publisher(graph: CellGraph) -> Findings:
    """Yield each publisher of a state that another one publishes already: of a joint, or of what counts newest."""
    for topic in graph.cell.interfaces:
        if topic.kind is not InterfaceKind.TOPIC or len(topic.sources) < 2:
            continue
        first: dict[_Part, Endpoint] = {}
        for source in topic.sources:
            parts = tuple(_parts(graph, topic, source, first))
            again = next((part for part in parts if part in first), None)
            if again is not None:
                what = f"the state of `{again[1]}`" if again[1] else "what counts newest"
                message = f"`{source.node}` and `{first[again].node}` both publish {what} on `{topic.name}`"
                yield found(graph, source.path, message, related=(Related("first published here", first[again].span),))
            for part in parts:
                first.setdefault(part, source)


@rule(Severity.ERROR, assumes=("shared-prefix", "device-of-two-managers"))
def joint_without_state(graph: CellGraph) -> Findings:
    """Yield broadcasters that are given a list of joints without one whose state nothing else publishes there."""
    listed = [
        (manager, controller)
        for manager in graph.cell.managers
        for controller in manager.controllers
        if controller.written_parameters.get("joints") and controller.parameters.get("interfaces")
    ]
    for manager, controller in listed:
        names = {topic.name for topic in controller.own_topics if topic.type == JOINT_STATE_TYPE and topic.publishes}
        for topic in graph.cell.interfaces:
            without = _unpublished(graph, manager, controller, topic) if topic.name in names else ()
            if without:
                more = f" and {len(without) - 1} more" if len(without) > 1 else ""
                message = f"`{controller.name}` must publish `{without[0]}`{more}, because nothing else does"
                path = (*controller.path, "parameters", "joints")
                yield found(graph, path, message, f"add `{without[0]}`{more}, or delete the list")


def _unpublished(
    graph: CellGraph, manager: ControllerManager, controller: Controller, topic: Interface
) -> tuple[str, ...]:
    """Return the joints of a manager with a state of their own of which a topic says nothing on a target."""
    said = set[_Part]()
    for source in topic.sources:
        joints = _joints(graph, source)
        if joints is None:
            return ()  # of a node, nothing says which joints it publishes
        said.update(joints)
    return tuple(
        joint.name
        for device in map(graph.cell.device, manager.devices)
        for joint in device.joints
        if device.control.hardware is not None and joint.mimics is None and "position" in joint.state_interfaces
        for target in controller.targets[:1]
        if target in device.control.hardware.targets and (target, joint.name) not in said
    )


def _parts(graph: CellGraph, topic: Interface, source: Endpoint, known: Iterable[_Part]) -> Iterator[_Part]:
    """Yield what a publisher speaks of; of joints, a node of which nothing says it speaks of all that have none yet."""
    if topic.type != JOINT_STATE_TYPE:
        yield from ((target, "") for target in source.targets if topic.wants == "newest")
        return
    joints = _joints(graph, source)
    if joints is not None:
        yield from joints
        return
    moving = {joint.name for device in graph.cell.devices for joint in device.joints if joint.type != "fixed"}
    said = set(known)
    for target in source.targets:
        parts = {(target, joint) for joint in moving}
        yield from sorted(parts - said or parts)


def _joints(graph: CellGraph, source: Endpoint) -> tuple[_Part, ...] | None:
    """Return the joints of a controller or device; None of a node, which may speak of any."""
    if (broadcaster := graph.once(_controllers).get(source.node)) is not None:
        return tuple(_broadcast(graph.cell, *broadcaster))
    joints = graph.once(_joints_of_devices).get(source.node)
    return None if joints is None else tuple((target, joint) for target in source.targets for joint in joints)


def _controllers(graph: CellGraph) -> Mapping[str, tuple[ControllerManager, Controller]]:
    return {
        controller.label: (manager, controller)
        for manager in reversed(graph.cell.managers)
        for controller in reversed(manager.controllers)
    }


def _joints_of_devices(graph: CellGraph) -> Mapping[str, tuple[str, ...]]:
    return {device.name: tuple(joint.name for joint in device.joints) for device in reversed(graph.cell.devices)}


def _broadcast(cell: Cell, manager: ControllerManager, controller: Controller) -> Iterator[_Part]:
    """Yield the joints of a broadcaster: those that it is given, else those of the hardware of its manager."""
    given = controller.parameters
    listed, extra = (_texts(given.get(name)) for name in ("joints", "extra_joints"))
    chosen = listed if listed and given.get("interfaces") else ()
    for target in controller.targets:
        for device in map(cell.device, manager.devices):
            hardware = device.control.hardware
            if hardware is not None and target in hardware.targets:
                yield from ((target, joint.name) for joint in device.joints if not chosen or joint.name in chosen)
        yield from ((target, joint) for joint in extra)


def _texts(value: object) -> tuple[str, ...]:
    return tuple(item for item in value if isinstance(item, str)) if isinstance(value, tuple) else ()
