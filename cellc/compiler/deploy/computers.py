"""What the package states of each computer: versions, network cards, routes, environment, kernel and clock."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.site import Host
from cellc.compiler.deploy.processes import used_hosts
from cellc.compiler.deploy.versions import compared_on
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.observation import ObservedCard, ObservedComputer, ObservedRoute
from cellc.contract.vocabulary import UNKNOWN

CHRONY = "chrony"
"""What disciplines a clock whose offset `observe` reads."""


def computers(graph: CellGraph) -> dict[str, ObservedComputer]:
    """Return what each computer must show, by its host; by an empty name where the spec states no host."""
    hosts = used_hosts(graph.cell) or ("",)
    shown = {host or hosts[0]: tuple(part.shown for part in parts) for host, parts in compared_on(graph.cell)}
    return {name: _computer(graph, graph.cell.hosts.get(name), shown.get(name, ())) for name in hosts}


def _computer(graph: CellGraph, host: Host | None, versions: tuple[str, ...]) -> ObservedComputer:
    environment = dict(_environment(graph.cell))
    controls = bool(graph.cell.managers) if host is None else host.name in graph.cell.managing_hosts
    if host is None:
        return ObservedComputer(versions=versions, environment=environment, controls=controls)
    cards = {
        nic.name: ObservedCard(
            address=nic.text, interface=host.nics[nic.name].interface, speed_bps=host.nics[nic.name].speed_bps
        )
        for nic in graph.network.cards.get(host.name, {}).values()
        if nic.interface is not None
    }
    return ObservedComputer(
        versions=versions,
        cards=cards,
        routes={
            device.device: ObservedRoute(address=str(device.address), card=device.nic)
            for device in graph.network.devices_of.get(host.name, ())
            if device.nic in cards and device.nic and device.address is not None
        },
        environment=environment,
        scheduling=host.scheduling,
        controls=controls,
        max_offset_s=host.clock.max_offset_s if host.clock.synchronized_by == CHRONY else None,
    )


def _environment(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield the variables by which nodes find each other, as ``middleware/HOST.sh`` sets them."""
    yield "ROS_DOMAIN_ID", str(cell.network.domain_id)
    if cell.versions.rmw_name != UNKNOWN:
        yield "RMW_IMPLEMENTATION", cell.versions.rmw_name
