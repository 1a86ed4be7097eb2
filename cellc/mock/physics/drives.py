"""How far joints were from their commands, and how long drives gave all that they have, over a stretch of time."""

from __future__ import annotations

from collections.abc import Container, Iterator

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.mock.physics.dynamics import Dynamics

_LEAST = 1e-3
"""rad or m: a joint that is nearer to its command is on it."""
_SHORT_NS = 10_000_000
"""A drive that gives all it has for less begins or ends a motion, and is no finding."""
_ALL = 1.0 - 1e-9
"""Share of what a drive gives at most from which on it has no more."""


@dataclass(frozen=True, slots=True)
class Away:
    """A joint where it was farthest from its command.

    Attributes:
        by: rad or m.
        effort: of its drive there, N m or N.
        limit: of the drive; infinite where none is stated.
        slides: so that it has m and N for rad and N m.
    """

    joint: str
    stamp_ns: int
    by: float
    effort: float
    limit: float
    slides: bool

    def __str__(self) -> str:
        by = f"{self.by * 1e3:.3g} {'mm' if self.slides else 'mrad'}"
        most = "" if np.isinf(self.limit) else f" of {self.limit:.3g}"
        given = f"its drive gives {abs(self.effort):.3g}{most} {'N' if self.slides else 'N m'}"
        return f"joint {self.joint} is farthest from its command, {by} at {self.stamp_ns / 1e9:.3f} s, {given}"


def farthest(dynamics: Dynamics, since_ns: int, grippers: Container[str]) -> Away | None:
    """Return the joint that was farthest from its command since an instant; None where all were on it.

    Args:
        grippers: joints that are to stay away from their commands, with a part between fingers.
    """
    scene = dynamics.scene
    joints = [joint for joint in scene.drives if joint not in grippers]
    times, states, commands = dynamics.since(since_ns)
    if not joints or not len(times):
        return None
    columns = [scene.drives[joint] for joint in joints]
    by = np.abs(scene.positions(states, joints) - commands[:, columns])
    row, column = (int(at) for at in np.unravel_index(int(by.argmax()), by.shape))
    if by[row, column] <= _LEAST:
        return None
    joint, drive = joints[column], columns[column]
    effort = float(scene.efforts(states[row : row + 1])[0, drive])
    limit = float(scene.limits[drive])
    return Away(joint, int(times[row]), float(by[row, column]), effort, limit, joint in scene.sliding)


@dataclass(frozen=True, slots=True)
class Spent:
    """A drive that gave all it has, N m or N, for some time in all."""

    joint: str
    first_ns: int
    lasted_ns: int
    limit: float
    slides: bool

    def __str__(self) -> str:
        most = f"{self.limit:.3g} {'N' if self.slides else 'N m'}"
        lasted = f"for {self.lasted_ns / 1e6:.0f} ms in all"
        return f"the drive of {self.joint} gives all its {most} {lasted}, from {self.first_ns / 1e9:.3f} s on"


def spent(dynamics: Dynamics, since_ns: int, grippers: Container[str]) -> Iterator[Spent]:
    """Yield the drives that gave all they have since an instant, but for those of grippers."""
    scene = dynamics.scene
    times, states, _ = dynamics.since(since_ns)
    over = np.abs(scene.efforts(states)) >= _ALL * scene.limits
    passed_ns = np.diff(times, prepend=since_ns)
    for joint, drive in scene.drives.items():
        at = np.flatnonzero(over[:, drive])
        lasted_ns = int(passed_ns[at].sum())
        if joint not in grippers and lasted_ns >= _SHORT_NS:
            yield Spent(joint, int(times[at[0]]), lasted_ns, float(scene.limits[drive]), joint in scene.sliding)
