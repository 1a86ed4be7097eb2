"""What controllers commanded, update by update, and where a command had a reason not to go on smoothly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass


class Cause(str, Enum):
    """Why a controller's command may step; each is what the real controller does too."""

    UNWRITTEN = "unwritten"  # no command in the update in which a tolerance is violated
    HOLD = "hold"  # a plain hold of the measured position, on cancel, abort or activation
    DECELERATION = "deceleration"  # constrained stop on cancel: its acceleration begins and ends abruptly
    REPLACED = "replaced"  # a trajectory takes over from one that was moving
    OFF_COMMAND = "off_command"  # a trajectory starts from a measured position that was not the commanded one
    SCALING = "scaling"  # the speed scaling factor changed


@dataclass(frozen=True, slots=True)
class Interruption:
    """From the update at ``stamp_ns`` on, the command of a controller need not continue the one before.

    Attributes:
        until_ns: until then it need not be smooth either; the same stamp for a single step.
    """

    stamp_ns: int
    until_ns: int
    controller: str
    cause: Cause


@dataclass(frozen=True, slots=True)
class CommandSamples:
    """Commands of one controller after each of its updates, limited as they were written.

    Attributes:
        interfaces: command interfaces, as `joint/interface`.
        stamps_ns: times of the updates, shape (updates,).
        values: commands, shape (updates, interfaces); NaN where nothing was commanded yet.
    """

    controller: str
    interfaces: tuple[str, ...]
    stamps_ns: NDArray[np.int64]
    values: NDArray[np.float64]


@dataclass(slots=True)
class _Kept:
    """Pieces of the samples of one controller."""

    columns: list[int]
    stamps_ns: list[NDArray[np.int64]] = field(default_factory=list)
    values: list[NDArray[np.float64]] = field(default_factory=list)


class CommandJournal:
    """Records commands and interruptions while there is a listener; costs nothing otherwise.

    Attributes:
        listening: set by a listener that takes the journal.
        interface_names: names of the command interfaces by column.
    """

    def __init__(self) -> None:
        self.listening = False
        self.interface_names: list[str] = []
        self._kept: dict[str, _Kept] = {}
        self._interruptions: list[Interruption] = []

    def add(
        self, controller: str, columns: Sequence[int], stamps_ns: NDArray[np.int64], commands: NDArray[np.float64]
    ) -> None:
        """Keep updates of a controller; ``commands`` has all command interfaces as columns."""
        if not self.listening or not len(columns):
            return
        log = self._kept.setdefault(controller, _Kept(list(columns)))
        log.stamps_ns.append(stamps_ns)
        log.values.append(commands[:, log.columns])

    def note(self, stamp_ns: int, controller: str, cause: Cause, lasting_ns: int = 0) -> None:
        """Keep an interruption."""
        if self.listening:
            self._interruptions.append(Interruption(stamp_ns, stamp_ns + lasting_ns, controller, cause))

    def take(self) -> tuple[tuple[CommandSamples, ...], tuple[Interruption, ...]]:
        """Hand over what was kept since the last time."""
        logs, self._kept = self._kept, {}
        interruptions, self._interruptions = tuple(self._interruptions), []
        return tuple(self._samples(name, pieces) for name, pieces in logs.items()), interruptions

    def _samples(self, controller: str, kept: _Kept) -> CommandSamples:
        names = tuple(self.interface_names[column] for column in kept.columns)
        return CommandSamples(controller, names, np.concatenate(kept.stamps_ns), np.concatenate(kept.values))
