"""Commands that start the cell at a gate; on real hardware a person opens it with the word that the gate asks for."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.formats.bringup import activation
from cellc.formats.confirmation import CONFIRMATION, MOTION_CONFIRMATION
from cellc.formats.hosts import launch_hosts
from cellc.formats.movers import movers, started_by_a_person


def start_mock(cell: Cell) -> str:
    """Return what starts the whole cell on the mock."""
    return f"ros2 launch {cell.name} cell.launch.xml"


def start_real(cell: Cell) -> tuple[str, ...]:
    """Return what a person starts on each host: it connects, reads and claims, and enables nothing."""
    command = f"{start_mock(cell)} target:=real confirm_real:={CONFIRMATION}"
    return tuple(f"{command} host:={host}" for host in launch_hosts(cell)) or (command,)


def move_mock(cell: Cell) -> tuple[str, ...]:
    """Return what starts the nodes that ask for motion, on the mock; none where the cell has no such node."""
    return (f"ros2 launch {cell.name} move.launch.xml",) if _launched(cell) else ()


def move_real(cell: Cell) -> tuple[str, ...]:
    """Return what a person starts or activates before motion, on each host."""
    command = f"ros2 launch {cell.name} move.launch.xml target:=real confirm_motion:={MOTION_CONFIRMATION}"
    launched = tuple(f"{command} host:={host}" for host in launch_hosts(cell)) or (command,)
    managed = tuple(activation(node) for node in movers(cell) if node.lifecycle)
    return (*(launched if _launched(cell) else ()), *managed)


def _launched(cell: Cell) -> bool:
    return any(started_by_a_person(cell, node) for node in movers(cell))
