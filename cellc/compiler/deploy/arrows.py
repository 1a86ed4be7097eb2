"""The arrows of the cell's graph: who publishes, serves or calls what, who claims, who moves, and what stops."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Endpoint, Interface, NodeSource
from cellc.compiler.deploy.labels import (
    NO_DRIVER,
    claim_facts,
    driver_facts,
    helper_facts,
    interface_facts,
    rates_of_controllers,
    real_driver,
    stop_facts,
    unused,
    unused_facts,
    unused_title,
)
from cellc.compiler.graph.claims import claimed_by_device
from cellc.compiler.graph.versions import device_pins
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN, InterfaceKind

ArrowKind = Literal["topic", "service", "action", "claims", "moves", "helps", "stops"]


@dataclass(frozen=True, slots=True)
class Arrow:
    """What goes from its starts to its ends: samples, requests, commands, or the stop.

    Args:
        starts: nodes, controllers and devices by their labels; empty where the cell has none.
        ends: likewise.
        title: name of the interface, or what is done.
        facts: what the arrow promises, in short lines.
    """

    kind: ArrowKind
    starts: tuple[str, ...]
    ends: tuple[str, ...]
    title: str
    facts: tuple[str, ...]

    @property
    def is_unknown(self) -> bool:
        """Whether something of it is UNKNOWN, or nothing is known that carries it."""
        return any(UNKNOWN in fact or NO_DRIVER in fact for fact in (*self.starts, *self.ends, *self.facts))


def exchanges(cell: Cell) -> Iterator[Arrow]:
    """Yield the interfaces of the cell; those without a reader or client come last, by server and owner."""
    groups = unused(cell)
    alone = {interface.name for group in groups for interface in group}
    rates = rates_of_controllers(cell)
    for interface in cell.interfaces:
        if interface.name not in alone:
            yield _exchange(interface, interface.name, tuple(interface_facts(interface, rates)))
    for group in groups:
        yield _exchange(group[0], unused_title(group), tuple(unused_facts(group)))


def _exchange(interface: Interface, title: str, facts: tuple[str, ...]) -> Arrow:
    sources, sinks = _labels(interface.sources), _labels(interface.sinks)
    # A sample travels to the subscriber, a goal or a request to the server.
    starts, ends = (sources, sinks) if interface.kind is InterfaceKind.TOPIC else (sinks, sources)
    return Arrow(interface.kind.value, starts, ends, title, facts)


def _labels(ends: tuple[Endpoint, ...]) -> tuple[str, ...]:
    return tuple(end.node for end in ends)


def drives(cell: Cell) -> Iterator[Arrow]:
    """Yield claims at every device whose interface is claimed, and what moves a device past every controller."""
    for manager in cell.managers:
        for controller in manager.controllers:
            for device, claimed in claimed_by_device(cell, controller).items():
                facts = tuple(claim_facts(cell, manager, controller, claimed, cell.device(device)))
                yield Arrow("claims", (controller.label,), (device,), "claims", facts)
    for driven in cell.devices:
        if driven.control.driver is not None:
            facts = tuple(driver_facts(cell, driven, driven.control.driver))
            yield Arrow("moves", (driven.control.driver.node,), (driven.name,), "moves", facts)


def helpers(cell: Cell) -> Iterator[Arrow]:
    """Yield the nodes of drivers that have no end of an interface of the cell, each with its device."""
    named = {end.full_name for interface in cell.interfaces for end in (*interface.sources, *interface.sinks)}
    driving = {device.control.driver.node for device in cell.devices if device.control.driver is not None}
    for node in cell.nodes:
        if node.source is NodeSource.DEVICE and node.full_name not in named | driving:
            device = cell.device(str(node.path[1]))
            facts = tuple(helper_facts(device, node))
            yield Arrow("helps", (node.name if not node.namespace else node.full_name,), (device.name,), "helps", facts)


def unknown_boxes(cell: Cell) -> frozenset[str]:
    """Name devices, nodes and authorities of which something is UNKNOWN: versions, owners, or what moves a device."""
    open_pins = {pin.holder for pin in device_pins(cell) if not pin.known}
    moved = (device for device in cell.devices if device.control.is_driven)
    driverless = {device.name for device in moved if real_driver(device) == NO_DRIVER}
    nodes = {node.full_name: node.owner for node in cell.nodes}
    unowned = {name for name, owner in nodes.items() if owner == UNKNOWN}
    labels = {name.rpartition("/")[2] for name in unowned}
    return frozenset({*open_pins, *driverless, *unowned, *labels, UNKNOWN})


def stop(cell: Cell) -> Iterator[Arrow]:
    """Yield the physical stop, where a device is driven."""
    devices = tuple(device.name for device in cell.devices if device.control.is_driven)
    if devices:
        title = "stops, independent of software"
        yield Arrow("stops", (cell.safety.stop.authority,), devices, title, tuple(stop_facts(cell)))
