"""Clocks of the contract: one for each host, one for each device that stamps on a clock of its own, and /clock."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.device import Device
from cellc.contract.clock import ContractClock
from cellc.spec.devices import StampSpec
from cellc.spec.hosts import ClockSpec

SIM = "sim"
UNKNOWN = "UNKNOWN"


def clocks(cell: Cell) -> dict[str, ContractClock]:
    """Return every clock by the name of the host or device that it ticks in."""
    found = {name: _clock(host.clock, host.clock.domain) for name, host in cell.spec.hosts.items()}
    for device in cell.devices:
        if (stamp := _own_clock(cell, device)) is not None:
            found[_clock_name(cell, device)] = _clock(stamp, stamp.clock)
    if any(node.clock == SIM for node in cell.nodes):
        found[SIM] = ContractClock(domain=SIM, simulated=True)
    return found


def clock_of(cell: Cell) -> dict[str, str]:
    """Return the name of the clock that each node, controller and device stamps and ages with."""
    return {name: clock for name, clock in _clock_of(cell) if clock is not None}


def _clock_of(cell: Cell) -> Iterator[tuple[str, str | None]]:
    hosts = cell.spec.hosts
    only_host = next(iter(hosts)) if len(hosts) == 1 else None
    for node in cell.nodes:
        yield node.name, SIM if node.clock == SIM else node.host
    for manager in cell.managers:
        for controller in manager.controllers:
            yield controller.name, manager.host or only_host
            yield controller.label, manager.host or only_host
    for device in cell.devices:
        connection = device.spec.connection
        host = only_host if connection is None else connection.host
        yield device.name, _clock_name(cell, device) if _own_clock(cell, device) is not None else host


def _own_clock(cell: Cell, device: Device) -> StampSpec | None:
    """Return the stamp of a device whose clock is not that of a host."""
    stamp = device.spec.stamp
    domains = {host.clock.domain for host in cell.spec.hosts.values()}
    return None if stamp is None or stamp.clock in (UNKNOWN, *domains) else stamp


def _clock_name(cell: Cell, device: Device) -> str:
    return f"{device.name}/clock" if device.name in cell.spec.hosts else device.name


def _clock(written: ClockSpec | StampSpec, domain: str) -> ContractClock:
    offset, drift = written.simulated_offset, written.simulated_drift
    return ContractClock(
        domain=domain,
        synchronised_by=written.synchronised_by,
        max_offset_s=None if written.max_offset is None else written.max_offset.si,
        offset_s=0.0 if offset is None else offset.si,
        drift=0.0 if drift is None else drift.si,
    )
