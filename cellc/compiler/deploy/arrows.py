"""The arrows of the cell's graph: who publishes, serves or calls what, who claims, who moves, and what stops."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.deploy.labels import (
    claim_facts,
    driver_facts,
    interface_facts,
    rates_of_controllers,
    stop_facts,
    unused,
    unused_facts,
    unused_title,
)
from cellc.compiler.graph.claims import claimed_by_device
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import InterfaceKind

ArrowKind = Literal["topic", "service", "action", "claims", "moves", "stops"]


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


def stop(cell: Cell) -> Iterator[Arrow]:
    """Yield the physical stop, where a device is driven."""
    devices = tuple(device.name for device in cell.devices if device.control.is_driven)
    if devices:
        title = "stops, independent of software"
        yield Arrow("stops", (cell.safety.stop.authority,), devices, title, tuple(stop_facts(cell)))
