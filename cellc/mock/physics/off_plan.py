"""How far joints with masses were from their plans in motions that succeeded, where a bound of the cell is near."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.mock.physics.dynamics import Dynamics
from cellc.mock.physics.motions import Motion, motions

_NEAR = 0.5
"""Share of a path tolerance from which on what is left is worth a word."""

Spans = Sequence[tuple[str, int, int]]
"""Steps with their begin and end in simulated ns."""


def off_plan(
    dynamics: Dynamics, spans: Spans, path_tolerances: Mapping[str, float], goal_tolerances: Mapping[str, float]
) -> Iterator[str]:
    """Yield what is worth a word: the worst path error, and the worst overshoot, of all steps.

    Args:
        path_tolerances: of joints, rad or m: beyond them a controller ends its goal.
        goal_tolerances: of joints, within which a controller calls its goal reached.
    """
    path = max(_path_errors(dynamics, spans, path_tolerances), key=lambda each: each.share, default=None)
    if path is not None and path.share >= _NEAR:
        yield str(path)
    found = [
        (motion.overshoot / goal_tolerances[motion.joint], motion, step)
        for step, began_ns, ended_ns in spans
        for motion in motions(dynamics, began_ns, until_ns=ended_ns)
        if motion.joint in goal_tolerances
    ]
    share, motion, step = max(found, key=lambda each: each[0], default=(0.0, None, ""))
    if motion is not None and share > 1.0:
        yield _overshoot(motion, step, goal_tolerances[motion.joint])


def _overshoot(motion: Motion, step: str, tolerance: float) -> str:
    by, allowed = motion.length(motion.overshoot), motion.length(tolerance)
    return f"overshoot: joint {motion.joint} passes its end by {by} in `{step}`; its goal tolerance is {allowed}"


@dataclass(frozen=True, slots=True)
class PathError:
    """A joint where it was farthest from its command, by the share of its path tolerance."""

    joint: str
    slides: bool
    step: str
    stamp_ns: int
    by: float
    tolerance: float

    @property
    def share(self) -> float:
        """Of the tolerance."""
        return self.by / self.tolerance

    def __str__(self) -> str:
        unit = "mm" if self.slides else "mrad"
        by, most = (f"{value * 1e3:.3g} {unit}" for value in (self.by, self.tolerance))
        where = f"in `{self.step}`, at {self.stamp_ns / 1e9:.3f} s"
        return f"path error: joint {self.joint} is {by} from its command {where}; {most} would end its goal"


def _path_errors(dynamics: Dynamics, spans: Spans, tolerances: Mapping[str, float]) -> Iterator[PathError]:
    """Yield the worst of each joint in each step."""
    scene = dynamics.scene
    joints = [joint for joint in scene.drives if joint in tolerances]
    for step, began_ns, ended_ns in spans if joints else ():
        times, states, commands = dynamics.since(began_ns, ended_ns)
        if not len(times):
            continue
        by = np.abs(scene.positions(states, joints) - commands[:, [scene.drives[joint] for joint in joints]])
        for column, row in enumerate(by.argmax(axis=0).tolist()):
            joint, slides = joints[column], joints[column] in scene.sliding
            yield PathError(joint, slides, step, int(times[row]), float(by[row, column]), tolerances[joint])
