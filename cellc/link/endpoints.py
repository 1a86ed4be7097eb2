"""Who may stand at the end of an interface, under which names, and what devices and controllers offer there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from cellc.cell.control import Controller, ControllerManager
from cellc.cell.interface import TARGETS, Endpoint, Node, NodeSource, Qos, node_labels
from cellc.diagnostics import Span, YamlPath
from cellc.link.devices import BoundDevice
from cellc.link.qos import DEFAULT, QosResolver
from cellc.spec.cell_spec import CellSpec


@dataclass(frozen=True, slots=True)
class EndName:
    """A node, a device or a controller that may stand at an end.

    Args:
        node: its name in the spec, unlike that of any other.
        full_name: fully qualified name of the node behind it.
        owner: who answers for it.
        targets: targets on which it runs.
        nodes: full names of the nodes that offer single interfaces, for a device whose driver has several.
        offered: QoS of the topics that it publishes, by full name.
    """

    node: str
    full_name: str
    owner: str
    targets: tuple[str, ...] = TARGETS
    nodes: Mapping[str, str] = field(default_factory=dict)
    offered: Mapping[str, Qos] = field(default_factory=dict)

    def end(self, interface: str, path: YamlPath, span: Span, qos: Qos | None = None) -> Endpoint:
        """Return this end of an interface; without a QoS it has what is offered there."""
        return Endpoint(
            node=self.node,
            full_name=self.nodes.get(interface, self.full_name),
            qos=qos or self.offered.get(interface, DEFAULT),
            path=path,
            span=span,
            targets=self.targets,
        )


@dataclass(frozen=True, slots=True)
class EndpointNames:
    """What may stand at the end of an interface.

    Args:
        known: by the name in the spec, and by the full name of its node.
        shared: names that several controllers have → their full names, by which alone they can be told apart.
    """

    known: Mapping[str, EndName]
    shared: Mapping[str, tuple[str, ...]]


def name_endpoints(
    spec: CellSpec,
    devices: tuple[BoundDevice, ...],
    nodes: tuple[Node, ...],
    managers: tuple[ControllerManager, ...],
    resolver: QosResolver,
) -> EndpointNames:
    """Collect nodes, devices and controllers with their owners, and what devices publish with which QoS."""
    controllers = tuple(controller for manager in managers for controller in manager.controllers)
    own = [node for node in nodes if node.source is not NodeSource.DEVICE]
    words = {
        label: EndName(label, node.full_name, node.owner) for node, label in zip(own, node_labels(own), strict=True)
    }
    words |= {one.device.name: _of_device(one, nodes, spec, resolver) for one in devices}
    command = spec.owners.responsibilities.command
    words |= {c.label: EndName(c.label, c.full_name, command, c.targets) for c in controllers}
    full = {end.full_name: end for end in words.values()}
    full |= {node.full_name: _of_node(node) for node in nodes if node.full_name not in full}
    return EndpointNames(full | words, _shared(controllers))


def _of_node(node: Node) -> EndName:
    """Name a node by its full name: others share the bare one, or its device stands for it."""
    targets = ("real",) if node.real_only else TARGETS
    return EndName(node.full_name, node.full_name, node.owner, targets)


def _shared(controllers: tuple[Controller, ...]) -> dict[str, tuple[str, ...]]:
    shared: dict[str, tuple[str, ...]] = {}
    for one in controllers:
        if one.label != one.name:
            shared[one.name] = (*shared.get(one.name, ()), one.label)
    return shared


def _of_device(bound: BoundDevice, nodes: tuple[Node, ...], spec: CellSpec, resolver: QosResolver) -> EndName:
    device = bound.device
    own = next((node.full_name for node in nodes if node.device == device.name), f"/{device.name}")
    return EndName(
        node=device.name,
        full_name=own,
        owner=spec.owners.responsibilities.vendor_safety,
        nodes={one.name: one.node for one in device.offers if any(n.full_name == one.node for n in nodes)},
        offered=dict(_offered(bound, resolver)),
    )


def _offered(bound: BoundDevice, resolver: QosResolver) -> Iterator[tuple[str, Qos]]:
    known, facts = bound.names, bound.facts
    for topic in facts.topics:
        yield known.fill(topic.name), resolver.writer(topic.qos)
    if facts.camera is not None:
        for stream in facts.camera.streams.values():
            yield known.fill(stream.topic), resolver.writer(stream.qos)
            yield known.fill(stream.info_topic), resolver.writer(stream.info_qos)
