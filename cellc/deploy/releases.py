"""Commands that start the cell at a gate, and the words with which a person opens the real target."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.deploy.bringup import activation
from cellc.deploy.processes import launch_hosts, motion_clients, started_by_a_person

CONFIRMATION = "I_HAVE_PASSED_GATES_G0_TO_G2"
"""Releases the real target: connecting, reading, claiming."""

MOTION_CONFIRMATION = "I_HAVE_PASSED_GATES_G0_TO_G6"
"""Releases motion on the real target: what sends goals is started."""


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
    managed = tuple(activation(node) for node in motion_clients(cell) if node.lifecycle)
    return (*(launched if _launched(cell) else ()), *managed)


def _launched(cell: Cell) -> bool:
    return any(started_by_a_person(cell, node) for node in motion_clients(cell))
