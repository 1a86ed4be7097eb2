"""Clocks of the contract: one for each host, one for each device that stamps on a clock of its own, and /clock."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.site import Clock
from cellc.contract.contract import ContractClock
from cellc.contract.vocabulary import UNKNOWN

_SIM = "sim"


def clocks(cell: Cell) -> dict[str, ContractClock]:
    """Return every clock by the name of the host or device that it ticks in."""
    clocks = {name: _clock(host.clock) for name, host in cell.hosts.items()}
    for device in cell.devices:
        if (clock := _own_clock(cell, device)) is not None:
            clocks[_clock_name(cell, device)] = _clock(clock)
    if any(node.clock == _SIM for node in cell.nodes):
        clocks[_SIM] = ContractClock(domain=_SIM, simulated=True)
    return clocks


def clock_of(cell: Cell) -> dict[str, str]:
    """Return the name of the clock that each node, controller and device stamps and ages with."""
    return {name: clock for name, clock in _clock_of(cell) if clock}


def _clock_of(cell: Cell) -> Iterator[tuple[str, str]]:
    for node in cell.nodes:
        yield node.name, _SIM if node.clock == _SIM else node.host
    for manager in cell.managers:
        for controller in manager.controllers:
            yield controller.name, manager.host
            yield controller.label, manager.host
    for device in cell.devices:
        yield device.name, _clock_name(cell, device) if _own_clock(cell, device) is not None else device.site.host


def _own_clock(cell: Cell, device: Device) -> Clock | None:
    """Return the clock that a device stamps with, unless it is that of a host."""
    domains = {host.clock.domain for host in cell.hosts.values()}
    clock = None if device.sensing.stamp is None else device.sensing.stamp.clock
    return None if clock is None or clock.domain in (UNKNOWN, *domains) else clock


def _clock_name(cell: Cell, device: Device) -> str:
    return f"{device.name}/clock" if device.name in cell.hosts else device.name


def _clock(clock: Clock) -> ContractClock:
    return ContractClock(
        domain=clock.domain,
        synchronized_by=clock.synchronized_by,
        max_offset_s=clock.max_offset_s,
        offset_s=clock.simulated_offset_s,
        drift=clock.simulated_drift,
    )
