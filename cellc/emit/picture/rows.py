"""The arrows of the cell as rows: from whom, what, to whom."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.interface import Interface, InterfaceKind
from cellc.deploy.labels import claim_facts, driver_facts, interface_facts, stop_facts


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
        Band(f"Vendor control (owner {owners.vendor_safety})", True, (*_claims(cell), *_drivers(cell))),
        Band(f"Physical safety (owner {owners.physical_stop})", True, tuple(_stops(cell))),
    )


def _exchange(interface: Interface) -> Row:
    sources = tuple(end.node for end in interface.sources)
    sinks = tuple(end.node for end in interface.sinks)
    # A sample travels to the subscriber, a goal or a request to the server.
    starts, ends = (sources, sinks) if interface.kind is InterfaceKind.TOPIC else (sinks, sources)
    return Row(starts or ("nobody",), interface.name, tuple(interface_facts(interface)), ends or ("nobody",))


def _claims(cell: Cell) -> Iterator[Row]:
    for manager in cell.managers:
        for controller in manager.controllers:
            if controller.device is not None and controller.command_interfaces:
                facts = tuple(claim_facts(cell, manager, controller))
                yield Row((controller.label,), "claims", facts, (controller.device,))


def _drivers(cell: Cell) -> Iterator[Row]:
    """Yield what moves a device past every controller manager."""
    for device in cell.devices:
        if device.driver is not None:
            yield Row((device.driver.node,), "moves", tuple(driver_facts(cell, device, device.driver)), (device.name,))


def _stops(cell: Cell) -> Iterator[Row]:
    devices = tuple(device.name for device in cell.devices if device.hardware is not None)
    if devices:
        yield Row((cell.spec.safety.stop.authority,), "stops, whatever software says", tuple(stop_facts(cell)), devices)
