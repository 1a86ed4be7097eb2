"""The arrows of the cell as rows: from whom, what, to whom."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.interface import Interface, InterfaceKind
from cellc.formats.interface_label import interface_facts


@dataclass(frozen=True, slots=True)
class Row:
    """One arrow with what it carries; several names at an end share it."""

    starts: tuple[str, ...]
    title: str
    facts: tuple[str, ...]
    ends: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Band:
    """Rows within one boundary; a bold one is not crossed by software of the cell."""

    title: str
    bold: bool
    rows: tuple[Row, ...]


def bands(cell: Cell) -> tuple[Band, ...]:
    """Return the ROS graph, vendor control and physical safety, in the order in which a goal meets them."""
    owners = cell.spec.owners.responsibilities
    return (
        Band("ROS 2 graph", False, tuple(map(_exchange, cell.interfaces))),
        Band(f"Vendor control (owner {owners.vendor_safety})", True, tuple(_claims(cell))),
        Band(f"Physical safety (owner {owners.physical_stop})", True, tuple(_stops(cell))),
    )


def _exchange(interface: Interface) -> Row:
    sources = tuple(end.node for end in interface.sources)
    sinks = tuple(end.node for end in interface.sinks)
    # A sample travels to the subscriber, a goal or a request to the server.
    starts, ends = (sources, sinks) if interface.kind is InterfaceKind.TOPIC else (sinks, sources)
    return Row(starts or ("nobody",), interface.name, tuple(interface_facts(interface)), ends or ("nobody",))


def _claims(cell: Cell) -> Iterator[Row]:
    for controller in cell.controllers:
        if controller.device is not None and controller.command_interfaces:
            device = cell.device(controller.device)
            state = "from start-up" if controller.active else "as an alternate, inactive at start-up"
            facts = (
                ", ".join(controller.command_interfaces),
                f"through {device.hardware.plugins['real'] if device.hardware else 'no hardware'}; {state}",
                f"on a violation: {controller.on_violation}; architecture: {device.spec.architecture}",
            )
            yield Row((controller.name,), "claims", facts, (device.name,))


def _stops(cell: Cell) -> Iterator[Row]:
    stop, recovery = cell.spec.safety.stop, cell.spec.safety.recovery
    devices = tuple(device.name for device in cell.devices if device.hardware is not None)
    if devices:
        facts = (
            f"path {stop.path}, independent of {', '.join(stop.independent_of) or 'nothing stated'}",
            f"recovery acknowledged by {recovery.acknowledge}, owner {recovery.owner}",
        )
        yield Row((stop.authority,), "stops, whatever software says", facts, devices)
