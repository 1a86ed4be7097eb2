"""What joints and parts did that a plan does not have: droop, overshoot, a stopping distance, a fall."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.mock.control.interfaces import Array
from cellc.mock.physics.dynamics import Dynamics

_LEAST = 1e-3
"""rad or m, and rad/s or m/s: by less no joint is away from its command, and slower none moves."""
_SETTLED_NS = 300_000_000
"""After which a part that was put down lies; no robot has moved by then."""
_SETTLES_M = 0.002
"""By which a part may move as it is put down."""
_TOPPLED = math.radians(45.0)
"""A part that leans so far beyond how it rested has passed its balance, whatever its edges are."""


@dataclass(frozen=True, slots=True)
class Motion:
    """How a joint moved at the end of a stretch of time, rad or m.

    Attributes:
        droop: from where it is to its command; zero while it moves or its command does.
        overshoot: by which it passed where it is now, after its command had come to rest.
        way: from where it was at the beginning to where it was farthest from there.
        speed: at the end.
    """

    joint: str
    slides: bool
    droop: float
    overshoot: float
    way: float
    speed: float

    def length(self, value: float) -> str:
        """Return a length of this joint with its unit."""
        return f"{abs(value) * 1e3:.3g} {'mm' if self.slides else 'mrad'}"


def motions(
    dynamics: Dynamics, since_ns: int, but: Collection[str] = (), until_ns: int | None = None
) -> Iterator[Motion]:
    """Yield how each driven joint moved since an instant.

    Args:
        but: joints that are left out.
        until_ns: the end of the stretch; None for now.
    """
    scene, joints = dynamics.scene, [joint for joint in dynamics.scene.drives if joint not in but]
    times, states, commands = dynamics.since(since_ns, until_ns)
    if not joints or len(times) < 2:
        return
    positions, speeds = scene.positions(states, joints), scene.velocities(states[-1], joints)
    led = commands[:, [scene.drives[joint] for joint in joints]]
    for column, joint in enumerate(joints):
        at, command, speed = positions[:, column], led[:, column], float(speeds[column])
        still = abs(speed) < _LEAST and command[-1] == command[-2]
        droop = float(command[-1] - at[-1]) if still else 0.0
        way = float(np.abs(at - at[0]).max())
        yield Motion(joint, joint in scene.sliding, droop, _overshoot(at, command), way, abs(speed))


def _overshoot(at: Array, command: Array) -> float:
    changes = np.flatnonzero(np.diff(command))
    if not changes.size:
        return 0.0
    rests = int(changes[-1]) + 1
    forth = math.copysign(1.0, float(command[rests] - command[rests - 1]))
    return max(0.0, float((forth * (at[rests:] - at[-1])).max()))


def drooping(found: Sequence[Motion]) -> str:
    """Say which joint rests farthest from its command; empty where all are on theirs, or move."""
    worst = max(found, key=lambda each: abs(each.droop), default=None)
    if worst is None or abs(worst.droop) < _LEAST:
        return ""
    return f"droop: joint {worst.joint} rests {worst.length(worst.droop)} from its command"


def passing(found: Sequence[Motion]) -> str:
    """Say which joint passed farthest beyond where it is; empty where none did."""
    worst = max(found, key=lambda each: each.overshoot, default=None)
    if worst is None or worst.overshoot < _LEAST:
        return ""
    return f"overshoot: joint {worst.joint} passes its end by {worst.length(worst.overshoot)}"


def stopping(found: Sequence[Motion]) -> str:
    """Say which joint moved on farthest after a stop was asked for, and how fast it still moves; empty without any."""
    worst = max(found, key=lambda each: (each.speed >= _LEAST, each.way), default=None)
    if worst is None or worst.way < _LEAST:
        return ""
    still = f", and still moves at {worst.length(worst.speed)}/s" if worst.speed >= _LEAST else ""
    return f"stopping distance: joint {worst.joint} goes on by {worst.length(worst.way)}{still}"


def unsupported(dynamics: Dynamics) -> Iterator[str]:
    """Yield the parts that did not rest where the cell has them: they drop, or are pushed up, as time begins."""
    times, states, _ = dynamics.since(-1, _SETTLED_NS)
    for part in dynamics.scene.parts if len(times) else ():
        first, last = (dynamics.scene.pose(row, part).position[2] for row in (states[0], states[-1]))
        if abs(last - first) > _SETTLES_M:
            moved = f"moves {abs(last - first) * 1e3:.3g} mm {'down' if last < first else 'up'} as time begins"
            why = "floats above" if last < first else "sinks into"
            yield f"support: {part} {moved}: by its `size` and its frame it {why} what is below it"


def toppled(dynamics: Dynamics, since_ns: int, held: Collection[str]) -> Iterator[str]:
    """Yield the parts that no gripper holds and that lean far beyond how they rested at an instant."""
    _, states, _ = dynamics.since(since_ns)
    if not len(states):
        return
    for part in dynamics.scene.parts:
        first, last = dynamics.scene.pose(states[0], part), dynamics.scene.pose(states[-1], part)
        (x, y, z), (u, v, w) = (
            tuple(tip - foot for tip, foot in zip(pose.apply((0.0, 0.0, 1.0)), pose.position, strict=True))
            for pose in (first, last)
        )
        leans = math.acos(max(-1.0, min(1.0, x * u + y * v + z * w)))
        if part not in held and leans > _TOPPLED:
            moved_mm = math.dist(first.position, last.position) * 1e3
            yield f"knocked over: {part} leans by {math.degrees(leans):.0f} deg, {moved_mm:.3g} mm from where it rested"
