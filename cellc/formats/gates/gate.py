"""One gate: what is checked in which state of the robot, the evidence it leaves, and what stops it."""

from __future__ import annotations

from dataclasses import dataclass

_STARTS = ("ros2 launch ", "ros2 bag record ")


@dataclass(frozen=True, slots=True)
class Check:
    """One line to tick; ``commands`` read and never change anything at the cell, or start what its gate releases."""

    text: str
    commands: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Gate:
    """A gate of chapter 4.

    Args:
        code: ``G0`` to ``G7``, ``L1`` to ``L6``.
        shows: what has been shown once it is passed, in one phrase.
        state: state that the robot or its drives are in.
        evidence: name of the file that the gate must leave.
        owner: who signs, from the spec.
        stop: conditions under which nobody goes on.
    """

    code: str
    title: str
    shows: str
    state: str
    checks: tuple[Check, ...]
    evidence: str
    owner: str
    stop: tuple[str, ...]

    @property
    def key_command(self) -> str:
        """The first command that reads, empty for a gate that people alone pass."""
        commands = (command for check in self.checks for command in check.commands if not starts(command))
        return next(commands, "")


def starts(command: str) -> bool:
    """Tell whether a command starts a part of the cell and stays in its shell, rather than reads and ends."""
    return command.startswith(_STARTS)
