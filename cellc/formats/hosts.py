"""Where the processes of a cell run, as its launch files and its pages for people say it."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.cell.interface import Node


def launch_hosts(cell: Cell) -> tuple[str, ...]:
    """Return the hosts on which something is started, in the order of the spec; empty where all runs in one place."""
    used = {host_of(cell, node) for node in cell.nodes} | {host_of_manager(cell, one) for one in cell.managers}
    hosts = tuple(host for host in cell.spec.hosts if host in used)
    return hosts if len(hosts) > 1 else ()


def host_of(cell: Cell, node: Node) -> str:
    """Return the host of a node; one without a stated host runs beside the first controller manager."""
    return node.host or _home(cell)


def host_of_manager(cell: Cell, manager: ControllerManager) -> str:
    """Return the host of an update loop."""
    return manager.host or _home(cell)


def _home(cell: Cell) -> str:
    stated = [manager.host for manager in cell.managers if manager.host is not None]
    return [*stated, *cell.spec.hosts, ""][0]
