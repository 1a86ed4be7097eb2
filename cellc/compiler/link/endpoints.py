"""What may stand at the end of an interface, under which names, and with which quality of service."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from typing import get_args

from cellc.compiler.catalog.device_graph import QosFacts, QosUse
from cellc.compiler.catalog.tables import KnownEndpoint, QosTable, Rmw, SystemDefault
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.interface import Endpoint, Node, NodeSource, node_labels
from cellc.compiler.cell.motion import Servo
from cellc.compiler.link.devices import BoundDevice
from cellc.compiler.link.names import JOINT_STATES
from cellc.compiler.link.nodes import DESCRIPTION, description_home
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.interfaces import QosSpec
from cellc.compiler.spec.quantity import Quantity
from cellc.contract.diagnostics import Span, YamlPath
from cellc.contract.entities import TARGETS, Durability, Processing, Qos, Reliability, Target
from cellc.contract.frozen import dataclass
from cellc.contract.qos import DEFAULT

_UNWRITTEN = QosSpec()


def _with_changes(profile: Qos, written: QosSpec) -> Qos:
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

    @property
    def anybody(self) -> Iterator[KnownEndpoint]:
        """The ends of topics that are the same in every node, such as those of tf2."""
        return (row for row in self.table.endpoints if row.topic.startswith("/") and not row.is_of_a_program)

    def of_program(self, package: str, executable: str) -> Iterator[KnownEndpoint]:
        """Return the ends of a program."""
        return (row for row in self.table.endpoints if row.node in (package, f"{package}/{executable}"))

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


Offers = Mapping[tuple[str, bool], Qos]
"""QoS of the ends that something has by itself: full name of the topic, and whether it publishes it."""


@dataclass(frozen=True, slots=True)
class EndName:
    """A node, a device or a controller that may stand at an end.

    Args:
        node: its name in the spec, unlike that of any other.
        full_name: fully qualified name of the node behind it.
        owner: its owner.
        targets: targets on which it runs.
        nodes: full names of the nodes that offer single interfaces, for a device whose driver has several.
        offers: what the catalog says of its ends.
        publishes: topics that its program publishes whether the spec says so or not.
        processing: what it executes for each sample, by topic.
    """

    node: str
    full_name: str
    owner: str
    targets: tuple[Target, ...] = TARGETS
    nodes: Mapping[str, str] = field(default_factory=dict)
    offers: Offers = field(default_factory=dict)
    publishes: tuple[str, ...] = ()
    processing: Mapping[str, Processing] = field(default_factory=dict)

    def end(
        self, interface: str, path: YamlPath, span: Span, written: QosSpec = _UNWRITTEN, *, serves: bool
    ) -> Endpoint:
        """Return this end of an interface: what the spec states of its QoS, else the catalog, else the default.

        Args:
            interface: full name of the topic, service or action.
            path: where the spec speaks of the end, with its place in the files.
            written: QoS that the spec states.
            serves: whether it publishes, answers or executes.
        """
        return Endpoint(
            node=self.node,
            full_name=self.nodes.get(interface, self.full_name),
            qos=_with_changes(self.offers.get((interface, serves), DEFAULT), written),
            path=path,
            span=span,
            targets=self.targets,
            processing=None if serves else self.processing.get(interface),
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
    servo: Servo | None,
) -> EndpointNames:
    """Collect nodes, devices and controllers with their owners, and the ends that each has by itself with their QoS."""
    controllers = tuple(controller for manager in managers for controller in manager.controllers)
    everywhere = dict(_of_rows(resolver, "", resolver.anybody))
    named = [node for node in nodes if node.source is not NodeSource.DEVICE]
    apart = {manager.node: _own_description(manager) for manager in managers if len(managers) > 1}
    words = {
        label: _of_program(
            _of_node(node, label, everywhere),
            dict(_known_ends(node, {**node.remaps, **apart.get(node.full_name, {})}, resolver)),
        )
        for node, label in zip(named, node_labels(named), strict=True)
    }
    by_device: dict[str | None, list[str]] = {}
    for node in nodes:
        by_device.setdefault(node.device, []).append(node.full_name)
    names = frozenset(node.full_name for node in nodes)
    for device in devices:
        end = _of_device(device, by_device.get(device.device.name, ()), names, spec)
        words[end.node] = replace(end, offers=everywhere | dict(_offered(device, resolver)))
    command = spec.owners.responsibilities.command
    words |= {
        c.label: EndName(
            c.label, c.full_name, command, c.targets, offers=everywhere | dict(_of_controller(c, resolver))
        )
        for c in controllers
    }
    if servo is not None:
        # moveit2@2.12.4 moveit_ros/moveit_servo/src/servo_node.cpp:112,119: SystemDefaultsQoS.
        end, streamed = words[servo.node], {(servo.topic, True): resolver.writer("system_default")}
        words[servo.node] = replace(end, offers={**end.offers, **streamed})
    full = {end.full_name: end for end in words.values()}
    # Others share the bare name of a node that is named in full, or its device represents it.
    full |= {node.full_name: _of_node(node, node.full_name, everywhere) for node in nodes if node.full_name not in full}
    return EndpointNames(full | words, _shared(controllers))


def _of_node(node: Node, name: str, offers: Offers) -> EndName:
    targets = ("real",) if node.real_only else TARGETS
    processing = {
        topic: Processing(line=node.line_of(callback), takes_s=callback.takes_s)
        for topic, callback in node.callbacks.items()
        if callback.takes_s is not None
    }
    return EndName(name, node.full_name, node.owner, targets, offers=offers, processing=processing)


def _of_program(end: EndName, ends: Offers) -> EndName:
    publishes = tuple(name for name, said in ends if said)
    return replace(end, offers={**end.offers, **ends}, publishes=publishes)


def _own_description(manager: ControllerManager) -> dict[str, str]:
    """Return the name that the description has for one of several managers."""
    return {f"{manager.namespace}{DESCRIPTION}": f"{description_home(manager)}{DESCRIPTION}"}


def _known_ends(node: Node, remaps: Mapping[str, str], resolver: QosResolver) -> Iterator[tuple[tuple[str, bool], Qos]]:
    """Yield the ends that a program is known to have, by the names that they have in the cell, with their QoS."""
    rows = resolver.of_program(node.package, node.executable)
    for (name, publishes), qos in _of_rows(resolver, node.namespace, rows):
        yield (remaps.get(name, name), publishes), qos


def _of_rows(
    resolver: QosResolver, namespace: str, rows: Iterable[KnownEndpoint]
) -> Iterator[tuple[tuple[str, bool], Qos]]:
    for row in rows:
        said = row.direction == "publish"
        name = row.topic if row.topic.startswith("/") else f"{namespace}/{row.topic}"
        yield (name, said), resolver.writer(row.qos) if said else resolver.reader(row.qos)


def _of_controller(controller: Controller, resolver: QosResolver) -> Iterator[tuple[tuple[str, bool], Qos]]:
    for topic in controller.own_topics:
        use = topic.declared.qos
        yield (topic.name, topic.publishes), resolver.writer(use) if topic.publishes else resolver.reader(use)


def _shared(controllers: tuple[Controller, ...]) -> dict[str, tuple[str, ...]]:
    shared: dict[str, tuple[str, ...]] = {}
    for controller in controllers:
        if controller.label != controller.name:
            shared[controller.name] = (*shared.get(controller.name, ()), controller.label)
    return shared


def _of_device(bound: BoundDevice, driven: Sequence[str], names: Container[str], spec: CellSpec) -> EndName:
    device = bound.device
    alone = device.architecture == "direct_sdk" and bool(device.actuated_joints)  # its adapter has its name
    node = next(iter(() if alone else driven), f"/{device.name}")
    return EndName(
        node=device.name,
        full_name=node,
        owner=spec.owners.responsibilities.vendor_safety,
        nodes={offer.name: offer.node for offer in device.control.offers if offer.node in names},
    )


def _offered(bound: BoundDevice, resolver: QosResolver) -> Iterator[tuple[tuple[str, bool], Qos]]:
    known, facts = bound.names, bound.facts
    driver = facts.driver
    for topic in facts.topics:
        name, qos = known.fill(topic.name), resolver.writer(topic.qos)
        yield (name, True), qos
        if driver is not None and driver.joint_states == topic.name:
            yield (JOINT_STATES, True), qos
    if facts.camera is not None:
        for stream in facts.camera.streams.values():
            yield (known.fill(stream.topic), True), resolver.writer(stream.qos)
            yield (known.fill(stream.info_topic), True), resolver.writer(stream.info_qos)
