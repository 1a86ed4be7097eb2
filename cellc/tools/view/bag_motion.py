"""Joint positions of a bag as pictures, in bounded memory: fewer a second of a long one, none while at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellc.tools.attempt.heard import Heard, JointSample
from cellc.tools.view.playback import STEP_NS

MOST_PICTURES = 2400
"""Beyond them every second one goes: 96 s of motion are drawn at the full rate."""
_LONGEST_NS = 48 * 3600 * 1_000_000_000
"""What arrived later is not drawn: a bag of days is, but not a clock that jumps by years."""
_STILL = 1e-4
"""rad or m by which a joint must leave the last picture to be drawn again: encoders never rest."""
_FARTHEST = 1e6
"""rad or m beyond which a position is not drawn."""

_Positions = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Pictures:
    """Positions of joints at some times.

    Attributes:
        joints: that were heard of.
        times_ns: since the begin of the bag, by the arrival on the recording computer.
        positions: rad or m, shape (times, joints).
        step_ns: least time between two pictures.
        end_ns: of the newest state.
    """

    joints: tuple[str, ...]
    times_ns: tuple[int, ...]
    positions: _Positions
    step_ns: int
    end_ns: int


class PictureBuilder:
    """Takes the messages of a bag in the order of their arrival."""

    def __init__(self, joints: Sequence[str]) -> None:
        """Begin with nothing.

        Args:
            joints: those of the description; others are not drawn.
        """
        self._columns = {name: number for number, name in enumerate(joints)}
        self._now: _Positions = np.full(len(joints), np.nan)
        self._now_ns: int | None = None
        self._step_ns = STEP_NS
        self._kept: list[tuple[int, _Positions]] = []
        self._rest: tuple[int, _Positions] | None = None

    def take(self, at_ns: int, heard: Heard) -> None:
        """Take a message that arrived so long after the begin."""
        if not isinstance(heard, JointSample) or not 0 <= at_ns <= _LONGEST_NS:
            return
        if self._now_ns is not None and at_ns // self._step_ns > self._now_ns // self._step_ns:
            self._close(self._now_ns)
        for name, position in zip(heard.names, heard.positions.tolist(), strict=False):
            column = self._columns.get(name)
            if column is not None and abs(position) <= _FARTHEST:
                self._now[column] = position
                self._now_ns = max(at_ns, self._now_ns or 0)

    def pictures(self) -> Pictures:
        """Return what was kept; a joint is drawn where it was first heard of until then."""
        if self._now_ns is not None:
            self._close(self._now_ns)
        if self._rest is not None:  # how it ended
            self._kept.append(self._rest)
        table = np.array([row for _, row in self._kept]).reshape(len(self._kept), len(self._columns))
        known = [column for column in range(table.shape[1]) if np.isfinite(table[:, column]).any()]
        for column in known:
            first = int(np.flatnonzero(np.isfinite(table[:, column]))[0])
            table[:first, column] = table[first, column]
        names = tuple(self._columns)
        times_ns = tuple(at_ns for at_ns, _ in self._kept)
        return Pictures(
            tuple(names[column] for column in known), times_ns, table[:, known], self._step_ns, self._now_ns or 0
        )

    def _close(self, at_ns: int) -> None:
        """Keep a picture of a slot that ended, and where joints begin to move that of the slot before."""
        picture = at_ns, self._now.copy()
        if self._kept and _alike(self._kept[-1][1], self._now):
            self._rest = picture
            return
        if self._rest is not None:
            self._kept.append(self._rest)
        self._rest = None
        self._kept.append(picture)
        while len(self._kept) > MOST_PICTURES - 2:
            self._step_ns *= 2
            slots = [time_ns // self._step_ns for time_ns, _ in self._kept]
            last = [slot != later for slot, later in zip(slots, [*slots[1:], None], strict=True)]
            self._kept = [kept for kept, is_last in zip(self._kept, last, strict=True) if is_last]


def _alike(one: _Positions, other: _Positions) -> bool:
    """Tell whether no joint is elsewhere in one picture than in the other."""
    apart = np.abs(one - other)
    heard = np.isfinite(one) != np.isfinite(other)
    return not heard.any() and not (apart > _STILL).any()
