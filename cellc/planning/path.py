"""Geometric paths of a group, before they have times."""

from __future__ import annotations

from dataclasses import dataclass

Configuration = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class JointPath:
    """Sections of motion between standstills.

    A section of two waypoints is the straight edge between them in joint space. A section of more waypoints is the
    cubic spline through them; they have to be sampled evenly from a smooth motion, such as a straight line of the tip.
    Each section starts where the one before it ended.

    Attributes:
        joints: the order of every configuration.
        sections: waypoints, rad or metres.
    """

    joints: tuple[str, ...]
    sections: tuple[tuple[Configuration, ...], ...]

    @property
    def start(self) -> Configuration:
        """The first configuration."""
        return self.sections[0][0]

    @property
    def goal(self) -> Configuration:
        """The last configuration."""
        return self.sections[-1][-1]

    def then(self, other: JointPath) -> JointPath:
        """Return this path followed by another that starts where this one ends, with a standstill between them."""
        if other.joints != self.joints or other.start != self.goal:
            raise ValueError("a path must go on from the goal and with the joints of the path before it")
        return JointPath(self.joints, self.sections + other.sections)
