"""What a person releases at a gate: the launch file, the word that opens it, and the command."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.deploy.bringup import activation
from cellc.deploy.processes import launch_hosts, motion_clients, started_by_a_person


@dataclass(frozen=True, slots=True)
class Release:
    """One release of the real target.

    Args:
        file: the launch file.
        argument: what a person states, and ``word`` is the only value that opens.
        about: what the person states with it.
    """

    file: str
    argument: str
    word: str
    about: str


START = Release(
    "cell",
    "confirm_real",
    "I_HAVE_PASSED_GATES_G0_TO_G2",
    "Stated by the person who releases the real target: gates G0 to G2 have their evidence, drives are disabled.",
)
ACTIVATE = Release(
    "activate",
    "confirm_activation",
    "I_HAVE_PASSED_GATES_G0_TO_G4_AND_THE_AREA_IS_EMPTY",
    "Stated by the person who releases hardware that moves as it is activated: gates G0 to G4 have their evidence, "
    "nobody is in reach, nothing is held, no program of the robot is running.",
)
CLAIM = Release(
    "claim",
    "confirm_claim",
    "I_HAVE_PASSED_GATES_G0_TO_G6",
    "Stated by the person who releases claims on the real target: gates G0 to G6 have their evidence, the robot "
    "listens as its vendor says, nobody will jog it.",
)
MOVE = Release(
    "move",
    "confirm_motion",
    "I_HAVE_PASSED_GATES_G0_TO_G6",
    "Stated by the person who releases motion on the real target: gates G0 to G6 have their evidence, the observer "
    "stands at the stop.",
)


GOAL = Release(
    "goal",
    "confirm_goal",
    "I_HAVE_PASSED_GATES_G0_TO_G6",
    "Stated by the person who sends the first goal to the real target: gates G0 to G6 have their evidence, claims are "
    "released, the speed is low, the observer stands at the stop.",
)


def start_mock(cell: Cell) -> str:
    """Return what starts the whole cell on the mock."""
    return f"ros2 launch {cell.name} cell.launch.xml"


def start_real(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield who starts what on each host: it connects and reads; it claims and enables nothing."""
    command = f"{start_mock(cell)} target:=real {START.argument}:={START.word}"
    return _on_hosts(command, launch_hosts(cell))


def _on_hosts(command: str, hosts: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yield a command for each computer; the one of a cell that runs in one place is not named."""
    yield from ((f"On {host}: a person", f"{command} host:={host}") for host in hosts)
    if not hosts:
        yield "A person", command


def release_once(cell: Cell, release: Release) -> str:
    """Return what a person starts once, on one host: it asks, proves and ends."""
    return f"ros2 launch {cell.name} {release.file}.launch.xml {release.argument}:={release.word}"


def move_mock(cell: Cell) -> tuple[str, ...]:
    """Return what starts the nodes that ask for motion, on the mock; none where the cell has no such node."""
    return (f"ros2 launch {cell.name} move.launch.xml",) if _launched(cell) else ()


def move_real(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield who starts or activates what before motion, on each host that has something of it."""
    command = f"ros2 launch {cell.name} move.launch.xml target:=real {MOVE.argument}:={MOVE.word}"
    movers = {node.host for node in motion_clients(cell) if started_by_a_person(cell, node)}
    if _launched(cell):
        hosts = launch_hosts(cell)
        yield from _on_hosts(command, tuple(host for host in hosts if host in movers) or hosts)
    yield from (("A person", activation(node)) for node in motion_clients(cell) if node.lifecycle)


def _launched(cell: Cell) -> bool:
    return any(started_by_a_person(cell, node) for node in motion_clients(cell))
