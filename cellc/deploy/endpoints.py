"""Who stands at the interfaces of a running cell on the real target: what the spec names, and what comes beside it.

A driver's node listens to the controllers of its robot, the stopper of claims to what it watches, and a planner has a
client of each action that it executes on. A person who compares the graph with the page finds them all.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.interface import Endpoint, Interface, InterfaceKind
from cellc.contract.bring_up import CLAIM_WATCH
from cellc.deploy.bringup import bring_up
from cellc.deploy.processes import motion_clients, started_by_a_person


def ends_on_real(cell: Cell, interface: Interface) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the full names of who publishes or serves, and of who subscribes or calls."""
    late = {node.full_name for node in motion_clients(cell) if started_by_a_person(cell, node)}

    def named(ends: tuple[Endpoint, ...]) -> Iterator[str]:
        for end in ends:
            if "real" in end.targets:
                yield end.full_name + (" (from G7 on)" if end.full_name in late else "")

    sinks = dict.fromkeys((*named(interface.sinks), *_beside(cell, interface)))
    return tuple(dict.fromkeys(named(interface.sources))), tuple(sinks)


def _beside(cell: Cell, interface: Interface) -> Iterator[str]:
    """Yield who listens or calls though no line of the spec says so."""
    for node in cell.nodes if interface.kind is not InterfaceKind.ACTION else ():
        asked = node.endpoints.requests if interface.kind is InterfaceKind.SERVICE else node.endpoints.subscribes
        if interface.name in {node.remaps.get(one, one) for one in asked}:
            yield node.full_name
    if any(watch.while_holds.topic == interface.name for watch in bring_up(cell).watches):
        yield CLAIM_WATCH
