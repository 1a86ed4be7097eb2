"""What a person releases at a gate: the launch file, the word that opens it, and the command."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.hardware import Effect
from cellc.compiler.deploy.bringup import activation
from cellc.compiler.deploy.processes import launch_hosts, motion_clients, started_by_a_person
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Moment, Motion


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

    def word_for(self, device: str) -> str:
        """Return what opens it for one of several devices; the word itself where there is one."""
        return f"{self.word}_FOR_{device}" if device else self.word


START = Release(
    "cell",
    "confirm_real",
    "I_HAVE_PASSED_GATES_G0_TO_G2",
    "Confirmation of the person who authorizes the hardware launch. Gates G0 to G2 have their evidence. "
    "The drives are in the state that gate G3 names.",
)
ACTIVATE = Release(
    "activate",
    "confirm_activation",
    "I_HAVE_PASSED_GATES_G0_TO_G4_AND_THE_AREA_IS_EMPTY",
    "Confirmation of the person who authorizes hardware that moves on activation. Gates G0 to G4 have their evidence. "
    "No person is within reach. Nothing is held. No robot program is running.",
)
CLAIM = Release(
    "claim",
    "confirm_claim",
    "I_HAVE_PASSED_GATES_G0_TO_G6",
    "Confirmation of the person who authorizes claims on real hardware. Gates G0 to G6 have their evidence. "
    "The robot accepts commands, as its vendor describes. Jogging has ended.",
)
MOVE = Release(
    "move",
    "confirm_motion",
    "I_HAVE_PASSED_GATES_G0_TO_G6",
    "Confirmation of the person who authorizes motion on real hardware. Gates G0 to G6 have their evidence. "
    "The observer is at the stop.",
)


GOAL = Release(
    "goal",
    "confirm_goal",
    "I_HAVE_PASSED_GATES_G0_TO_G6",
    "Confirmation of the person who sends the first goal to real hardware. Gates G0 to G6 have their evidence. "
    "Claims are authorized. The speed is low. The observer is at the stop.",
)


def moved_by_activation(cell: Cell) -> Iterator[tuple[str, Effect]]:
    """Yield the devices that move as they are activated, with what happens: a person activates each again."""
    for device in cell.devices:
        effects = {} if device.control.hardware is None else device.control.hardware.effects
        effect = effects.get(Moment.ACTIVATE)
        if effect is not None and effect.motion not in (Motion.NONE, Motion.HOLDS):
            yield device.name, effect


def restart_of(cell: Cell) -> str:
    """Return which gates people repeat after the launches were stopped: what a person activated is inactive then."""
    activated = " and ".join(name for name, _ in moved_by_activation(cell))
    return (
        f"as in G4, and repeat the activation of {activated} in G5 with its checks"
        if activated
        else "as in G4, with the drives as they are"
    )


def start_mock(cell: Cell) -> str:
    """Return what starts the whole cell on the mock."""
    return f"ros2 launch {cell.name} cell.launch.xml"


def start_real(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield the hardware launch of each host: it connects and reads; it claims and enables nothing."""
    command = f"{start_mock(cell)} target:=real {START.argument}:={START.word}"
    return _on_hosts(command, launch_hosts(cell))


def _on_hosts(command: str, hosts: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yield a command for each computer, after its name; a cell that runs in one place names none."""
    yield from ((f"On {host}: ", f"{command} host:={host}") for host in hosts)
    if not hosts:
        yield "", command


def release_once(cell: Cell, release: Release, device: str = "") -> str:
    """Return the command that a person runs once, on one host: it asks, proves and ends."""
    return f"ros2 launch {cell.name} {release.file}.launch.xml {release.argument}:={release.word_for(device)}"


def move_mock(cell: Cell) -> tuple[str, ...]:
    """Return the launch of the motion clients on the mock; none where the cell has no motion client."""
    return (f"ros2 launch {cell.name} move.launch.xml",) if _launched(cell) else ()


def move_real(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield the commands that start or activate motion clients, on each host that has one."""
    command = f"ros2 launch {cell.name} move.launch.xml target:=real {MOVE.argument}:={MOVE.word}"
    movers = {node.host for node in motion_clients(cell) if started_by_a_person(cell, node)}
    if _launched(cell):
        hosts = launch_hosts(cell)
        yield from _on_hosts(command, tuple(host for host in hosts if host in movers) or hosts)
    yield from (("", activation(node)) for node in motion_clients(cell) if node.lifecycle)


def _launched(cell: Cell) -> bool:
    return any(started_by_a_person(cell, node) for node in motion_clients(cell))
