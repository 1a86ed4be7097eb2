"""What may stand at the end of an interface, under which names, and with which quality of service."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import field, replace
from typing import get_args

from cellc.compiler.catalog.device_graph import QosFacts, QosUse
from cellc.compiler.catalog.tables import QosTable, Rmw, SystemDefault
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.interface import Endpoint, Node, NodeSource, node_labels
from cellc.compiler.link.devices import BoundDevice
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.interfaces import QosSpec
from cellc.compiler.spec.quantity import Quantity
from cellc.contract.diagnostics import Span, YamlPath
from cellc.contract.entities import TARGETS, Durability, Qos, Reliability, Target
from cellc.contract.frozen import dataclass
from cellc.contract.qos import DEFAULT

SENSOR_DATA = replace(DEFAULT, reliability="best_effort", depth=5)
# robot_state_publisher and controller_manager, robot_description: latched.
LATCHED = replace(DEFAULT, durability="transient_local", depth=1)
# tf2_ros/qos.hpp: dynamic broadcaster and listener, static broadcaster and listener.
TF = replace(DEFAULT, depth=100)
TF_STATIC_LISTENER = replace(LATCHED, depth=100)


def with_changes(profile: Qos, written: QosSpec) -> Qos:
    """Return the profile with the policies that the user wrote in place of its own."""
    return Qos(
        reliability=written.reliability or profile.reliability,
        durability=written.durability or profile.durability,
        history=written.history or profile.history,
        depth=profile.depth if written.depth is None else written.depth,
        deadline_s=_seconds(written.deadline, profile.deadline_s),
        lifespan_s=_seconds(written.lifespan, profile.lifespan_s),
        liveliness=written.liveliness or profile.liveliness,
        lease_duration_s=_seconds(written.lease_duration, profile.lease_duration_s),
    )


def _seconds(written: Quantity | None, default: float | None) -> float | None:
    return default if written is None else written.si


@dataclass(frozen=True, slots=True)
class QosResolver:
    """Turns a catalog profile into what an endpoint really offers on the cell's middleware."""

    table: QosTable
    rmw: Rmw

    def writer(self, use: QosUse) -> Qos:
        """Return the profile of a publisher; what is left to the system is what the RMW makes of it."""
        return self._resolve(use, self.table.system_default[self.rmw].writer)

    def reader(self, use: QosUse) -> Qos:
        """Return the profile of a subscription; Fast DDS reads best effort where it writes reliably."""
        return self._resolve(use, self.table.system_default[self.rmw].reader)

    def _resolve(self, use: QosUse, system: SystemDefault) -> Qos:
        if isinstance(use, QosFacts):
            return replace(
                DEFAULT, reliability=use.reliability, durability=use.durability, history=use.history, depth=use.depth
            )
        profile = self.table.profiles[use]
        open_history = profile.history == "system_default"
        return replace(
            DEFAULT,
            reliability=_RELIABILITY.get(profile.reliability, system.reliability),
            durability=_DURABILITY.get(profile.durability, system.durability),
            history="keep_last" if profile.history == "system_default" else profile.history,
            depth=system.depth if open_history else max(1, profile.depth),
            lifespan_s=None if profile.lifespan is None else profile.lifespan.si,
        )


_RELIABILITY: Mapping[str, Reliability] = {name: name for name in get_args(Reliability)}
_DURABILITY: Mapping[str, Durability] = {name: name for name in get_args(Durability)}
"""What a profile may decide itself; the middleware decides what is left open."""


@dataclass(frozen=True, slots=True)
class EndName:
    """A node, a device or a controller that may stand at an end.

    Args:
        node: its name in the spec, unlike that of any other.
        full_name: fully qualified name of the node behind it.
        owner: its owner.
        targets: targets on which it runs.
        nodes: full names of the nodes that offer single interfaces, for a device whose driver has several.
        offered: QoS of the topics that it publishes, by full name.
    """

    node: str
    full_name: str
    owner: str
    targets: tuple[Target, ...] = TARGETS
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
        shared: names that several controllers have → their full names, by which alone they can be distinguished.
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
    named = [node for node in nodes if node.source is not NodeSource.DEVICE]
    words = {
        label: EndName(label, node.full_name, node.owner) for node, label in zip(named, node_labels(named), strict=True)
    }
    by_device: dict[str | None, list[str]] = {}
    for node in nodes:
        by_device.setdefault(node.device, []).append(node.full_name)
    names = frozenset(node.full_name for node in nodes)
    for device in devices:
        words[device.device.name] = _of_device(device, by_device.get(device.device.name, ()), names, spec, resolver)
    command = spec.owners.responsibilities.command
    words |= {c.label: EndName(c.label, c.full_name, command, c.targets) for c in controllers}
    full = {end.full_name: end for end in words.values()}
    full |= {node.full_name: _of_node(node) for node in nodes if node.full_name not in full}
    return EndpointNames(full | words, _shared(controllers))


def _of_node(node: Node) -> EndName:
    """Name a node by its full name: others share the bare one, or its device represents it."""
    targets = ("real",) if node.real_only else TARGETS
    return EndName(node.full_name, node.full_name, node.owner, targets)


def _shared(controllers: tuple[Controller, ...]) -> dict[str, tuple[str, ...]]:
    shared: dict[str, tuple[str, ...]] = {}
    for controller in controllers:
        if controller.label != controller.name:
            shared[controller.name] = (*shared.get(controller.name, ()), controller.label)
    return shared


def _of_device(
    bound: BoundDevice, driven: Sequence[str], names: Container[str], spec: CellSpec, resolver: QosResolver
) -> EndName:
    device = bound.device
    alone = device.architecture == "direct_sdk" and bool(device.actuated_joints)  # its adapter has its name
    node = next(iter(() if alone else driven), f"/{device.name}")
    return EndName(
        node=device.name,
        full_name=node,
        owner=spec.owners.responsibilities.vendor_safety,
        nodes={offer.name: offer.node for offer in device.control.offers if offer.node in names},
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
